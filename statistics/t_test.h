#pragma once

#include <span>

#include "statistics/interval.h"

namespace mimik::statistics {

/// Where the mean of a population lies of which the values are a sample: mean +- t sd / sqrt(n) (Student 1908). It
/// holds for values that know nothing of each other: pairs that share a subject do (statistics/bootstrap.h).
/// @throws InputError of fewer than 2 values, one that is not finite, or a confidence outside 0 to 1.
[[nodiscard]] Interval t_interval(std::span<const double> values, double confidence = 0.95);

struct TTest {
    double mean = 0;  ///< of first - second
    double t = 0;
    double degrees = 0;  ///< of freedom, n - 1
    double p = 1;        ///< two-sided
    Interval interval;   ///< of the mean difference
};

/// Whether the mean of first - second is 0.
/// @throws InputError as t_interval, or if one list is longer; NumericalError if all differences are the same.
[[nodiscard]] TTest paired_t_test(std::span<const double> first, std::span<const double> second,
                                  double confidence = 0.95);

}  // namespace mimik::statistics
