#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mimik::statistics {

/// Ranks from 1 on; values that are equal share the mean of their ranks.
[[nodiscard]] std::vector<double> mid_ranks(std::span<const double> values);
/// How many values are equal, for each value that occurs more than once.
[[nodiscard]] std::vector<std::size_t> tie_sizes(std::span<const double> values);

}  // namespace mimik::statistics
