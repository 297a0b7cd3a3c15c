#include "evaluation/source_dependence.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/errors.h"
#include "evaluation/numbered_names.h"

namespace mimik::evaluation {
namespace {

struct Case {
    std::uint32_t target = 0, source = 0;
    double error = 0;
};

std::size_t people(std::vector<std::uint32_t> numbers) {
    std::sort(numbers.begin(), numbers.end());
    return static_cast<std::size_t>(std::unique(numbers.begin(), numbers.end()) - numbers.begin());
}

/// @param places  of subjects, in the alphabet: sums are of one order, whatever that of the rows was
void fill(SourceDependence& one, std::vector<Case>& cases, const std::vector<std::uint32_t>& places) {
    for (auto& each : cases) each = {places[each.target], places[each.source], each.error};
    std::sort(cases.begin(), cases.end(),
              [](const Case& a, const Case& b) { return std::tie(a.target, a.source) < std::tie(b.target, b.source); });
    const auto twice = std::adjacent_find(cases.begin(), cases.end(), [](const Case& a, const Case& b) {
        return a.target == b.target && a.source == b.source;
    });
    if (twice != cases.end())
        throw InputError(
            fmt::format("rows of expression '{}' by '{}' hold a case twice; give each experiment's rows once",
                        one.expression, one.method));
    std::vector<double> errors;
    std::vector<std::uint32_t> source, target;
    for (const auto& each : cases) {
        errors.push_back(each.error);
        source.push_back(each.source);
        target.push_back(each.target);
        one.error += each.error / static_cast<double>(cases.size());
    }
    one.cases = cases.size();
    one.sources = people(source);
    one.targets = people(target);
    try {
        one.components = statistics::variance_components(errors, source, target);
    } catch (const NumericalError& e) {
        one.reason = e.what();
    }
}

}  // namespace

std::optional<double> SourceDependence::between_sources() const {
    if (!components) return std::nullopt;
    return std::sqrt(std::max(0.0, components->source.variance));
}

SourceDependences source_dependence(const CaseRowReader& read, const ComparisonOptions& options) {
    options.check();
    SourceDependences answer;
    NumberedNames subjects, expressions, methods;
    // By region, expression and method.
    std::map<std::tuple<std::size_t, std::uint32_t, std::uint32_t>, std::pair<SourceDependence, std::vector<Case>>>
        groups;
    read([&](const CaseRow& row) {
        if (row.estimator != options.estimator || row.metric != options.metric || !row.value) return;
        const auto region = std::find(options.regions.begin(), options.regions.end(), row.region);
        if (region == options.regions.end() || row.key.source.empty() || row.key.source == "mean") return;
        if (answer.unit.empty()) answer.unit = row.unit;
        if (row.unit != answer.unit)
            throw InputError(fmt::format("rows of '{}, {}' are in {} and in {}; choose a metric of one unit",
                                         options.estimator, options.metric, answer.unit, row.unit));
        const auto variant = variant_of(row.key);
        auto& [one, cases] = groups[{static_cast<std::size_t>(region - options.regions.begin()),
                                     expressions.number(row.key.expression), methods.number(variant)}];
        one.region = row.region;
        one.expression = row.key.expression;
        one.method = variant;
        cases.push_back({subjects.number(row.key.target), subjects.number(row.key.source), *row.value});
    });
    const auto places = subjects.places();
    for (auto& [key, group] : groups) {
        fill(group.first, group.second, places);
        answer.all.push_back(std::move(group.first));
    }
    return answer;
}

}  // namespace mimik::evaluation
