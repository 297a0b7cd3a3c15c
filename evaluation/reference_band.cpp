#include "evaluation/reference_band.h"

#include <algorithm>
#include <limits>
#include <set>

namespace mimik::evaluation {
namespace {

constexpr std::size_t fewest_of_a_mean = 11;

const MethodScores* true_field(const ExperimentReport& report, animation::SourceKind kind) {
    const auto row = std::find_if(report.rows.begin(), report.rows.end(), [&](const MethodScores& candidate) {
        return candidate.bound && candidate.kind == kind;
    });
    return row == report.rows.end() ? nullptr : &*row;
}

/// Of the expression that has the fewest: a target has one case per source, and one of their mean.
std::size_t sources_of_mean(const MethodScores& one, const MethodScores& mean) {
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const auto& [expression, score] : mean.per_expression)
        fewest = std::min(fewest, score.cases > 0 ? one.per_expression.at(expression).cases / score.cases : 0);
    return fewest;
}

}  // namespace

std::vector<ReferenceBand> reference_bands(const ExperimentReport& report) {
    const auto codes = [](const std::vector<facs::Expression>& expressions) {
        std::set<std::string> all;
        for (const auto& expression : expressions) all.insert(expression.code());
        return all;
    };
    if (codes(report.expressions) != codes(ExperimentOptions::thesis_expressions())) return {};
    const auto* one = true_field(report, animation::SourceKind::one_source);
    const auto* mean = true_field(report, animation::SourceKind::all_but_target);
    if (!one || !mean || !one->explained || !mean->explained) return {};
    std::vector<ReferenceBand> bands = {{animation::SourceKind::one_source, 0.41, 0.53, *one->explained}};
    if (sources_of_mean(*one, *mean) >= fewest_of_a_mean)
        bands.push_back({animation::SourceKind::all_but_target, 0.55, 0.65, *mean->explained});
    return bands;
}

}  // namespace mimik::evaluation
