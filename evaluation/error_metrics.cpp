#include "evaluation/error_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "geometry/statistics.h"

namespace mimik::evaluation {
namespace {

constexpr std::array curve_mm = {0.25, 0.5, 1.0, 2.0, 4.0};

double step_of(const std::string& unit) { return unit == "deg" ? 10.0 : unit == "1/m" ? 20.0 : 1.0; }

std::vector<MetricDefinition> define_all() {
    return {{"n", "vertices of the region that count"},
            {"coverage", "share of the region's vertices that count; the others were not measured, or met nothing"},
            {"mean", "mean over the vertices that count"},
            {"mean_absolute", "mean of the absolute values: differs from the mean where errors have a sign"},
            {"median", "the value below which half of the weight lies"},
            {"sd", "standard deviation: root of the mean squared difference from the mean"},
            {"rms", "root of the mean square"},
            {"p5", "5th percentile"},
            {"p95", "95th percentile"},
            {"max", "largest absolute value"},
            {"curve",
             "below_X: share of the weight with an absolute value below X; X is 0.25, 0.5, 1, 2, 4 mm, ten times that "
             "in degrees, twenty times that in 1/m"}};
}

double mean_of(const RegionErrors& region, double (*of)(double)) {
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < region.errors.size(); ++k) {
        sum += region.weights[k] * of(region.errors[k]);
        weight += region.weights[k];
    }
    return sum / weight;
}

double share_below(const RegionErrors& region, double limit) {
    double below = 0, weight = 0;
    for (std::size_t k = 0; k < region.errors.size(); ++k) {
        if (std::abs(region.errors[k]) < limit) below += region.weights[k];
        weight += region.weights[k];
    }
    return below / weight;
}

double largest(const RegionErrors& region) {
    double most = 0;
    for (const double error : region.errors) most = std::max(most, std::abs(error));
    return most;
}

double spread(const RegionErrors& region) {
    const double mean = mean_of(region, [](double e) { return e; });
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < region.errors.size(); ++k) {
        sum += region.weights[k] * (region.errors[k] - mean) * (region.errors[k] - mean);
        weight += region.weights[k];
    }
    return std::sqrt(sum / weight);
}

double figure(const std::string& metric, const RegionErrors& region) {
    if (metric == "mean") return mean_of(region, [](double e) { return e; });
    if (metric == "mean_absolute") return mean_of(region, [](double e) { return std::abs(e); });
    if (metric == "rms") return std::sqrt(mean_of(region, [](double e) { return e * e; }));
    if (metric == "sd") return spread(region);
    if (metric == "max") return largest(region);
    const double q = metric == "p5" ? 0.05 : metric == "p95" ? 0.95 : 0.5;
    return weighted_quantile(region.errors, region.weights, q);
}

}  // namespace

void MetricOptions::check() const {
    for (const auto& metric : metrics) {
        const auto known = metric_definitions();
        if (std::any_of(known.begin(), known.end(), [&](const auto& one) { return one.name == metric; })) continue;
        std::vector<std::string> names;
        for (const auto& one : known) names.push_back(one.name);
        throw InputError(fmt::format("metric '{}' is unknown; there are: {}", metric, fmt::join(names, ", ")));
    }
}

std::span<const MetricDefinition> metric_definitions() {
    static const auto all = define_all();
    return all;
}

std::vector<Measure> figures_of(const RegionErrors& region, const std::string& region_name, const std::string& unit,
                                const MetricOptions& options, const std::string& also) {
    std::vector<Measure> measures;
    for (const auto& [metric, definition] : metric_definitions()) {
        const auto& asked = options.metrics;
        if (metric != also && std::find(asked.begin(), asked.end(), metric) == asked.end()) continue;
        if (metric == "n") {
            measures.push_back({region_name, metric, static_cast<double>(region.errors.size()), "vertices"});
        } else if (metric == "coverage") {
            const double counted = std::accumulate(region.weights.begin(), region.weights.end(), 0.0);
            if (region.weight_of_region > 0)
                measures.push_back({region_name, metric, counted / region.weight_of_region, "share"});
        } else if (region.errors.empty()) {
            continue;
        } else if (metric == "curve") {
            for (const double step : curve_mm) {
                const double limit = step * step_of(unit);
                measures.push_back({region_name, fmt::format("below_{}", limit), share_below(region, limit), "share"});
            }
        } else {
            measures.push_back({region_name, metric, figure(metric, region), unit});
        }
    }
    return measures;
}

double weighted_quantile(std::span<const double> values, std::span<const double> weights, double q) {
    const bool equal = std::adjacent_find(weights.begin(), weights.end(), std::not_equal_to<>()) == weights.end();
    if (equal) return geometry::quantile({values.begin(), values.end()}, q);
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    // A value stands at half of its own weight; the first stands at 0 and the last at 1.
    std::vector<double> place = {0};
    for (std::size_t k = 1; k < order.size(); ++k)
        place.push_back(place.back() + 0.5 * (weights[order[k - 1]] + weights[order[k]]));
    const double wanted = q * place.back();
    const auto above = std::lower_bound(place.begin(), place.end(), wanted);
    const auto k = static_cast<std::size_t>(above - place.begin());
    if (k == 0) return values[order.front()];
    const double step = place[k] - place[k - 1];
    const double share = step > 0 ? (wanted - place[k - 1]) / step : 1.0;
    return values[order[k - 1]] + share * (values[order[k]] - values[order[k - 1]]);
}

}  // namespace mimik::evaluation
