#pragma once

#include <vector>

namespace mimik::geometry {

/// The middle value, or the mean of the two middle ones. @throws InputError of no value.
[[nodiscard]] double median(std::vector<double> values);

/// q-quantile, linear between order statistics: position q (n - 1) in the sorted values (numpy's default, method 7 of
/// Hyndman and Fan 1996). @throws InputError if there is no value, one is NaN, or q is outside [0, 1].
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace mimik::geometry
