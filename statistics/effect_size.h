#pragma once

#include <span>

namespace mimik::statistics {

/// Cohen's dz: the mean of paired differences in their own standard deviations (Lakens 2013, Eq. 7).
/// @throws InputError of fewer than 2 differences or one that is not finite; NumericalError if all are the same.
[[nodiscard]] double cohen_dz(std::span<const double> differences);

/// By what dz is too large on average in samples with these degrees of freedom (n - 1 of dz), exactly: dz times it is
/// unbiased (Hedges 1981, Eq. 6e). 0.9227 of 10, about 1 - 3 / (4 degrees - 1).
/// @throws InputError for degrees of 1 or less.
[[nodiscard]] double hedges_correction(double degrees);

/// Cliff's delta: the share of pairs in which `first` is larger, minus that in which `second` is: -1 to 1
/// (Cliff 1993). Every value of one stands against every value of the other; they need not be as many.
/// @throws InputError if one has no value, or a value is not finite.
[[nodiscard]] double cliff_delta(std::span<const double> first, std::span<const double> second);

}  // namespace mimik::statistics
