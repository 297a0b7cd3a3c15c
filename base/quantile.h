#pragma once

#include <vector>

namespace mimik::base {

/// The value in the middle, or the mean of the two that stand there. @throws InputError of no value. Give no NaN.
[[nodiscard]] double median(std::vector<double> values);
/// The value in the middle; of an even number of values the upper one of the two there, so that it is always one of
/// them; 0 of none. Give no NaN.
[[nodiscard]] double upper_median(std::vector<double> values);

/// The value below which the share `q` of the values lies, linear between the two next to it: 0 the smallest, 1 the
/// largest (numpy's default, method 7 of Hyndman and Fan 1996). @throws InputError for no value, a NaN, or a share
/// outside 0 to 1.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace mimik::base
