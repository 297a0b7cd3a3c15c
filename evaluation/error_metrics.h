#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "evaluation/estimator.h"

namespace mimik::evaluation {

/// Which figures are made of the errors of a region, and how much each vertex counts.
struct MetricOptions {
    std::vector<std::string> metrics = {"mean", "median", "p95", "coverage"};
    bool area_weighted = false;  ///< by the area about it on the neutral face; else every vertex counts the same
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("metrics", self.metrics);
        visit("area_weighted", self.area_weighted);
    }
    /// @throws InputError listing the metrics there are.
    void check() const;
};
static_assert(base::lists_every_field<MetricOptions>());

struct MetricDefinition {
    std::string name, definition;
};
/// n, coverage, mean, mean_absolute, median, sd, rms, p5, p95, max, curve.
[[nodiscard]] std::span<const MetricDefinition> metric_definitions();

/// The errors of the vertices of one region.
struct RegionErrors {
    std::vector<double> errors;
    std::vector<double> weights;  ///< parallel to errors
    double weight_of_region = 0;  ///< of all its vertices, those that do not count among them
};

/// The figures that are asked for, in the order of metric_definitions(); `also` is measured though nobody asked. Sums
/// run in the order of the vertices. Of no error there is n, coverage and no other.
/// The curve is one figure per step: "below_0.25", ... in mm; ten times that in degrees; 5, 10, 20, 40, 80 in 1/m.
[[nodiscard]] std::vector<Measure> figures_of(const RegionErrors& region, const std::string& region_name,
                                              const std::string& unit, const MetricOptions& options,
                                              const std::string& also = {});

/// The value below which the share q of the weight lies, linear between values; of equal weights geometry::quantile().
/// @throws InputError of no value.
[[nodiscard]] double weighted_quantile(std::span<const double> values, std::span<const double> weights, double q);

}  // namespace mimik::evaluation
