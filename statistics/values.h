#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace mimik::statistics {

/// @param what  for the message: "a paired t test"
/// @throws InputError for fewer than `fewest` values, or one that is not finite.
void need_values(std::span<const double> values, std::size_t fewest, std::string_view what);
/// Likewise of two lists that go together. @throws InputError also if one is longer.
void need_pairs(std::span<const double> first, std::span<const double> second, std::size_t fewest,
                std::string_view what);

/// Whether the values differ by more than rounding leaves of equal ones.
[[nodiscard]] bool differ(std::span<const double> values);

[[nodiscard]] double mean_of(std::span<const double> values);
/// Sum of the squares of what the values are off their mean.
[[nodiscard]] double squares_about(std::span<const double> values, double mean);

}  // namespace mimik::statistics
