#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "evaluation/case_row.h"
#include "report/named_figure.h"
#include "report/svg_plot.h"
#include "statistics/bootstrap.h"

// What the thesis does not have: plots of an experiment's numbers, from its rows.csv.

namespace mimik::report::thesis_figures {
namespace {

/// The error of one method: mean distance to the real scan in the zone, a number per case.
struct MethodErrors {
    std::string name;
    std::vector<double> error_mm;
    std::vector<std::uint32_t> target;  ///< numbers that stand for subjects
};

std::vector<MethodErrors> read_errors(const std::string& file) {
    if (file.empty()) throw InputError("no file of rows is given; give --rows OUT/rows.csv of 'mimik run'");
    constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 31;
    const auto text = base::read_text(file, most_bytes);
    base::CsvReader table(text, file);
    const auto at = [&](const char* name) { return table.column(name); };
    const auto source = at("source"), target = at("target"), method = at("method"), magnitude = at("magnitude"),
               estimator = at("estimator"), region = at("region"), metric = at("metric"), value = at("value");
    std::map<std::string, std::uint32_t> people;
    const auto number_of = [&](const std::string& name) {
        return people.try_emplace(name, static_cast<std::uint32_t>(people.size())).first->second;
    };
    std::vector<MethodErrors> methods;
    while (table.next()) {
        if (table.field(estimator) != "surface_distance" || table.field(region) != "zone" ||
            table.field(metric) != "mean" || table.field(value).empty())
            continue;
        // Who is put on themselves knows their face: no case of two people.
        if (table.field(source) == table.field(target)) continue;
        const auto name = evaluation::variant_of(table.field(method), table.number(magnitude));
        auto found = std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
        if (found == methods.end()) found = methods.insert(methods.end(), MethodErrors{name, {}, {}});
        found->error_mm.push_back(table.number(value));
        found->target.push_back(number_of(table.field(target)));
    }
    if (methods.empty())
        throw InputError(fmt::format("{}: has no row of estimator surface_distance, region zone, metric mean", file));
    return methods;
}

constexpr const char* error_label = "mean distance to the scan in the zone, mm";

/// Without the folder: captions are the same wherever the command was typed.
std::string file_name(const FigureCast& cast) {
    return std::filesystem::path(cast.options().rows_file).filename().string();
}

FigurePlan boxes(const FigureCast& cast) {
    std::vector<PlotGroup> groups;
    for (auto& method : read_errors(cast.options().rows_file)) groups.push_back({method.name, method.error_mm});
    FigurePlan plan;
    plan.svg = box_plot_svg("Error of the methods", error_label, groups);
    plan.caption = fmt::format(
        "Error of each method over all cases of {}: median, quartiles, whiskers to 1.5 times the "
        "quartiles' distance, mean (diamond).",
        file_name(cast));
    return plan;
}

FigurePlan cumulative(const FigureCast& cast) {
    LinePlot plot{"Share of the cases with no greater error", error_label, "share of the cases", {}};
    for (const auto& method : read_errors(cast.options().rows_file))
        plot.lines.push_back({method.name, cumulative_steps(method.error_mm), plot_colour(plot.lines.size()),
                              plot.lines.size() % 2 == 1});
    FigurePlan plan;
    plan.svg = line_plots_svg(std::span(&plot, 1));
    plan.caption = fmt::format(
        "The share of the cases of {} whose error is not greater than the value on the axis, of "
        "each method.",
        file_name(cast));
    return plan;
}

FigurePlan intervals(const FigureCast& cast) {
    std::vector<PlotInterval> shown;
    for (const auto& method : read_errors(cast.options().rows_file)) {
        // Cases of one target go together; one draw of targets, since not every method has a source.
        const auto clusters = statistics::Clusters::one_way(method.target);
        const auto interval = statistics::bootstrap_interval(clusters, statistics::weighted_mean(method.error_mm));
        shown.push_back({method.name, interval.estimate, interval.interval.low, interval.interval.high,
                         fmt::format("n = {}", method.error_mm.size())});
    }
    FigurePlan plan;
    plan.svg = interval_plot_svg("Mean error of the methods, 95 % intervals", error_label, shown);
    plan.caption = fmt::format(
        "Mean error of each method over the cases of {}, with the interval that holds it with "
        "95 % (bias-corrected bootstrap of the targets, seed 1).",
        file_name(cast));
    return plan;
}

}  // namespace

std::vector<NamedFigure> plots_figures() {
    constexpr const char* needs = "--rows, the rows.csv of an experiment";
    return {{"plot-box", "Error of the methods: boxes", needs, FigureNeeds::rows, boxes},
            {"plot-cumulative", "Error of the methods: cumulative share of the cases", needs, FigureNeeds::rows,
             cumulative},
            {"plot-intervals", "Error of the methods: means with intervals", needs, FigureNeeds::rows, intervals}};
}

}  // namespace mimik::report::thesis_figures
