#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace mimik::statistics {

/// What a list of values is like, in their unit.
struct Description {
    std::size_t n = 0;
    double mean = 0;
    double median = 0;
    std::optional<double> sd;  ///< standard deviation with n - 1; empty: one value has none
    double rms = 0;            ///< root of the mean square
    double p05 = 0;            ///< quantiles as base::quantile()
    double p95 = 0;
    double min = 0;
    double max = 0;
};

/// @throws InputError of no value, or one that is not finite.
[[nodiscard]] Description describe(std::span<const double> values);

}  // namespace mimik::statistics
