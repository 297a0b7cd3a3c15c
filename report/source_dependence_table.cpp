#include "report/source_dependence_table.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/csv.h"

namespace mimik::report {

using evaluation::SourceDependence;
using evaluation::SourceDependences;

std::string to_markdown(const SourceDependences& dependences) {
    if (dependences.all.empty()) return {};
    std::string text =
        "Whose expression it was: the variance of the errors, split into what the source explains, what the target "
        "explains, and the rest; the spread is the standard deviation from source to source, p that the source is of "
        "no matter (docs/algorithms/statistics.md).\n";
    std::string region;
    for (const auto& one : dependences.all) {
        if (one.region != region) {
            region = one.region;
            text += fmt::format(
                "\nRegion `{}`:\n\n| method | expression | sources | targets | cases | error, {} | spread, {} | source "
                "| target | rest | p |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
                region, dependences.unit, dependences.unit);
        }
        text += fmt::format("| {} | {} | {} | {} | {} | {:.3f} |", one.method, one.expression, one.sources, one.targets,
                            one.cases, one.error);
        if (const auto& parts = one.components)
            text += fmt::format(" {:.3f} | {:.0f} % | {:.0f} % | {:.0f} % | {} |\n", *one.between_sources(),
                                100 * parts->source.share, 100 * parts->target.share, 100 * parts->residual.share,
                                parts->source.p < 0.0005 ? "< 0.001" : fmt::format("{:.3f}", parts->source.p));
        else
            text += " | | | | |\n";
    }
    return text;
}

std::string source_dependence_csv(const SourceDependences& dependences) {
    std::string text =
        "region,expression,method,cases,sources,targets,error,between_sources,unit,source_share,target_share,rest_"
        "share,"
        "f,p,reason\n";
    for (const auto& one : dependences.all) {
        text += fmt::format("{},{},{},{},{},{},{:.6f},", one.region, base::csv_field(one.expression),
                            base::csv_field(one.method), one.cases, one.sources, one.targets, one.error);
        if (const auto& parts = one.components)
            text += fmt::format("{:.6f},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},\n", *one.between_sources(),
                                dependences.unit, parts->source.share, parts->target.share, parts->residual.share,
                                parts->source.f, parts->source.p);
        else
            text += fmt::format(",{},,,,,,{}\n", dependences.unit, base::csv_field(one.reason));
    }
    return text;
}

}  // namespace mimik::report
