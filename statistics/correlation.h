#pragma once

#include <cstddef>
#include <span>

#include "statistics/interval.h"

namespace mimik::statistics {

/// How closely two measures of the same things go together: -1 to 1.
struct Correlation {
    double value = 0;
    double p = 1;       ///< two-sided, of no correlation
    Interval interval;  ///< by Fisher's z: tanh(atanh(value) +- quantile * error); -1 to 1 of too few values
    std::size_t n = 0;
    bool exact = false;  ///< p is of all orders there are, and no approximation
};

// All three throw InputError of fewer than 3 pairs, a value that is not finite, a confidence outside 0 to 1, or if one
// list is longer; NumericalError if all values of a list are the same.

/// Of straight lines. p by Student's t with n - 2 degrees of freedom, error 1 / sqrt(n - 3) (Fisher 1921).
[[nodiscard]] Correlation pearson(std::span<const double> x, std::span<const double> y, double confidence = 0.95);

/// Of ranks, equal values sharing theirs. p by t as of pearson(), error sqrt((1 + value^2 / 2) / (n - 3)) (Bonett and
/// Wright 2000).
[[nodiscard]] Correlation spearman(std::span<const double> x, std::span<const double> y, double confidence = 0.95);

/// Kendall's tau-b, of the order of pairs, corrected for ties (Kendall 1945). p exact of up to 33 pairs without ties,
/// else by the normal distribution, with the variance for ties; error sqrt(0.437 / (n - 4)) (Fieller, Hartley and
/// Pearson 1957).
[[nodiscard]] Correlation kendall(std::span<const double> x, std::span<const double> y, double confidence = 0.95);

}  // namespace mimik::statistics
