#include "report/estimator_table.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "evaluation/error_metrics.h"
#include "evaluation/estimator_choice.h"
#include "evaluation/scored_region.h"
#include "io/json_values.h"

namespace mimik::report {
namespace {

std::string text_of(const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string();
}

/// A bar would end the cell.
std::string in_cell(const std::string& text) {
    std::string cell;
    for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
    return cell;
}

}  // namespace

std::string estimators_markdown() {
    std::string text = "| estimator | unit | definition | blind to |\n| --- | --- | --- | --- |\n";
    for (const auto& one : evaluation::estimator_definitions())
        text += fmt::format("| `{}` | {} | {} | {} |\n", one.name, one.unit, in_cell(one.definition), one.blind_to);
    text += "\n| metric | definition |\n| --- | --- |\n";
    for (const auto& one : evaluation::metric_definitions())
        text += fmt::format("| `{}` | {} |\n", one.name, one.definition);
    const auto regions = evaluation::known_regions();
    const auto parts =
        std::find_if(regions.begin(), regions.end(), [](const auto& name) { return name.find('_') != name.npos; });
    return text + fmt::format(
                      "\nRegions: {}.\n\nParts of the face: {}.\n\nAlignments, before an estimator's name and a "
                      "slash: {}.\n",
                      fmt::join(regions.begin(), parts, ", "), fmt::join(parts, regions.end(), ", "),
                      fmt::join(evaluation::known_alignments(), ", "));
}

std::string estimators_json() {
    auto estimators = nlohmann::json::array(), metrics = nlohmann::json::array();
    for (const auto& one : evaluation::estimator_definitions())
        estimators.push_back({{"name", one.name},
                              {"spelled", one.spelled},
                              {"unit", one.unit},
                              {"metric", one.metric},
                              {"definition", one.definition},
                              {"blind_to", one.blind_to}});
    for (const auto& one : evaluation::metric_definitions())
        metrics.push_back({{"name", one.name}, {"definition", one.definition}});
    return io::json_text(nlohmann::json{{"schema", 1},
                                        {"estimators", estimators},
                                        {"metrics", metrics},
                                        {"regions", evaluation::known_regions()},
                                        {"alignments", evaluation::known_alignments()}});
}

std::string to_markdown(const evaluation::EstimatorCheck& check) {
    std::string text =
        "How well each estimator's error follows the true one (mean 3D distance to where the same skin point went), "
        "over pairs of subjects within one expression and one method:\n\n"
        "| estimator | method | expressions | cases | Pearson: least (of) | median | Spearman: least | median | "
        "Kendall: least |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    constexpr int digits = 2;
    for (const auto& one : check.summaries)
        text += fmt::format("| {} | {} | {} | {} | {}{} | {} | {} | {} | {} |\n", one.estimator, one.method,
                            one.expressions, one.cases, text_of(one.least_pearson, digits),
                            one.worst.empty() ? "" : fmt::format(" ({})", one.worst),
                            text_of(one.median_pearson, digits), text_of(one.least_spearman, digits),
                            text_of(one.median_spearman, digits), text_of(one.least_kendall, digits));
    text +=
        "\n| estimator | method | expression | n | Pearson | Spearman | Kendall | mean estimate | mean true, mm |\n"
        "| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    for (const auto& one : check.agreements)
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.2f} | {:.2f} |\n", one.estimator, one.method,
                            one.expression, one.n, text_of(one.pearson, digits), text_of(one.spearman, digits),
                            text_of(one.kendall, digits), one.estimate, one.true_mm);
    return text;
}

std::string to_csv(const evaluation::EstimatorCheck& check) {
    std::string text =
        "estimator,method,expression,region,metric,n,pearson,spearman,kendall,mean_estimate,mean_true_mm\n";
    constexpr int digits = 6;
    for (const auto& one : check.agreements)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{:.{}f},{:.{}f}\n", one.estimator, one.method, one.expression,
                            one.region, one.metric, one.n, text_of(one.pearson, digits), text_of(one.spearman, digits),
                            text_of(one.kendall, digits), one.estimate, digits, one.true_mm, digits);
    return text;
}

}  // namespace mimik::report
