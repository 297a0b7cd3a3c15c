#include "report/run_comparison_table.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/csv.h"
#include "evaluation/score.h"

namespace mimik::report {

using evaluation::ComparisonOptions;
using evaluation::MethodOfRuns;
using evaluation::RunComparison;

namespace {

/// Over all expressions, or of the one there is.
bool is_summary(const RunComparison& comparison, const MethodOfRuns& one) {
    const bool all = std::any_of(comparison.methods.begin(), comparison.methods.end(), [&](const MethodOfRuns& other) {
        return other.region == one.region && other.expression.empty();
    });
    return one.expression.empty() || !all;
}

std::string cell(const MethodOfRuns& one, std::size_t run) {
    if (!one.runs[run]) return "not run";
    if (one.method == evaluation::baseline_method || !one.runs[run]->explained)
        return fmt::format("{:.3f}", one.runs[run]->error);
    return fmt::format("{:.3f} ({:.3f})", one.runs[run]->error, *one.runs[run]->explained);
}

std::string differences(const RunComparison& comparison, const std::string& region) {
    std::string text = fmt::format(
        "\n| first - second | pairs | difference, {} | interval | p |\n| --- | ---: | ---: | --- | ---: |\n",
        comparison.unit);
    for (const auto& one : comparison.differences) {
        const bool several = std::any_of(comparison.differences.begin(), comparison.differences.end(),
                                         [&](const auto& other) { return other.expression.empty(); });
        if (one.region != region || one.expression.empty() != several) continue;
        text += fmt::format("| {} - {} | {} | {:.3f} | {} | {} |\n", one.first, one.second, one.pairs, one.difference,
                            one.interval ? fmt::format("{:.3f} to {:.3f}", one.interval->low, one.interval->high)
                                         : std::string("too few"),
                            one.p < 0.0005 ? std::string("< 0.001") : fmt::format("{:.3f}", one.p));
    }
    return text;
}

}  // namespace

std::string to_markdown(const RunComparison& comparison, const ComparisonOptions& options) {
    std::string text;
    for (const auto& region : options.regions) {
        text +=
            fmt::format("{}Error in region `{}`, {}, and in brackets what is explained of doing nothing:\n\n| method ",
                        text.empty() ? "" : "\n", region, comparison.unit);
        for (const auto& run : comparison.runs) text += "| " + run + " ";
        text += "|\n| --- ";
        for (std::size_t r = 0; r < comparison.runs.size(); ++r) text += "| ---: ";
        text += "|\n";
        for (const auto& one : comparison.methods) {
            if (one.region != region || !is_summary(comparison, one)) continue;
            text += "| " + one.method + " ";
            for (std::size_t r = 0; r < comparison.runs.size(); ++r) text += "| " + cell(one, r) + " ";
            text += "|\n";
        }
        text += differences(comparison, region);
    }
    text += fmt::format(
        "\nIntervals hold {:g} % (bootstrap of subjects, BCa, {} samples, seed {}); below 0 the first run is truer; p "
        "by "
        "sign flips over targets (docs/algorithms/statistics.md).\n",
        100 * options.confidence, options.resamples, options.seed);
    return text;
}

std::string run_comparison_csv(const RunComparison& comparison) {
    std::string text = "region,expression,method,run,cases,targets,error,unit,explained,explained_low,explained_high\n";
    for (const auto& one : comparison.methods)
        for (std::size_t r = 0; r < comparison.runs.size(); ++r) {
            const auto& own = one.runs[r];
            if (!own) continue;
            const auto& interval = own->explained_interval;
            text += fmt::format("{},{},{},{},{},{},{:.6f},{},{},{},{}\n", one.region, base::csv_field(one.expression),
                                base::csv_field(one.method), base::csv_field(comparison.runs[r]), own->cases,
                                own->targets, own->error, comparison.unit,
                                own->explained ? fmt::format("{:.6f}", *own->explained) : std::string(),
                                interval ? fmt::format("{:.6f}", interval->low) : std::string(),
                                interval ? fmt::format("{:.6f}", interval->high) : std::string());
        }
    return text;
}

}  // namespace mimik::report
