#pragma once

#include <span>

namespace mimik::statistics {

/// How much more one side does than the other; 0 = symmetric.
struct Asymmetry {
    double index = 0;  ///< sum |left - right| / sum (left + right): 0 every pair alike, 1 each pair on one side alone
    double side = 0;   ///< (sum left - sum right) / sum (left + right): -1 right alone, 0 as much on both, 1 left alone
};

/// Of magnitudes of motion at places that mirror each other, left and right the subject's own; |side| <= index. Skin
/// that moves 4 mm on the left and 2 mm on the right has 1/3 in both.
/// @throws InputError of no pair, a magnitude below 0 or not finite, or if one list is longer; NumericalError if
/// nothing moved.
[[nodiscard]] Asymmetry asymmetry_index(std::span<const double> left, std::span<const double> right);

}  // namespace mimik::statistics
