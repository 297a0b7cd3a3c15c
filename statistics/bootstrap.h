#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "statistics/clusters.h"
#include "statistics/interval.h"

namespace mimik::statistics {

enum class IntervalKind : std::uint8_t {
    percentile,  ///< quantiles of what the resamples gave
    bca          ///< bias-corrected and accelerated: right to one order more (Efron 1987)
};
[[nodiscard]] constexpr const char* to_string(IntervalKind kind) {
    return kind == IntervalKind::percentile ? "percentile" : "bca";
}

struct BootstrapOptions {
    std::uint64_t seed = 1;
    int resamples = 2000;      ///< the ends of a 95 % interval are then known to about 1.5 % of its width
    double confidence = 0.95;  ///< share
    IntervalKind kind = IntervalKind::bca;

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("seed", self.seed);
        visit("resamples", self.resamples);
        visit("confidence", self.confidence);
        visit("kind", self.kind);
    }
    void check() const;  ///< throws InputError
};

/// A number of cases that weigh differently: weights are whole numbers, not all 0. Called from any thread. NaN where
/// the cases that are left have none.
using WeightedStatistic = std::function<double(std::span<const double> weights)>;
/// sum w v / sum w. Keeps the span.
[[nodiscard]] WeightedStatistic weighted_mean(std::span<const double> values);
/// sum w a / sum w b; NaN where the lower one is 0. Keeps the spans.
[[nodiscard]] WeightedStatistic weighted_ratio(std::span<const double> above, std::span<const double> below);

struct BootstrapInterval {
    double estimate = 0;  ///< of the cases as they are
    Interval interval;
    double standard_error = 0;   ///< standard deviation of what the resamples gave
    double bias_correction = 0;  ///< z0 of bca
    double acceleration = 0;     ///< a of bca
    std::size_t resamples = 0;   ///< that gave a number: in the others nobody made a pair
};

/// Where a statistic lies, from samples of subjects drawn with replacement. The same seed gives the same bytes on any
/// number of threads; so does another order of the cases, but for rounding of the statistic.
///
/// bca: z0 is the normal quantile of the share of resamples below the estimate (half of those that equal it, and half a
/// resample away from 0 and 1); a comes from leaving out one subject after another, of both draws where there are two
/// (Efron and Tibshirani 1993, Eqs 14.10 to 14.15).
/// @throws InputError for bad options, fewer than 2 subjects in a draw, or as the statistic; NumericalError if it is
/// not finite, or in fewer than half of the resamples.
[[nodiscard]] BootstrapInterval bootstrap_interval(const Clusters& clusters, const WeightedStatistic& statistic,
                                                   const BootstrapOptions& options = {});

}  // namespace mimik::statistics
