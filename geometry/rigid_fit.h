#pragma once

#include <optional>
#include <span>

#include "geometry/types.h"

namespace mimik::geometry {

/// The rotation and translation for which sum_i w_i |T source_i - target_i|^2 is least (Kabsch 1976, by the singular
/// value decomposition; never a reflection). Empty where the pairs do not say a rotation: fewer than three of positive
/// weight, or all of them within `thinnest_ratio_of_rigid_fit` of their spread of one line.
/// @param weights  none below 0; empty: all alike @throws InputError if the counts differ.
[[nodiscard]] std::optional<Transform> rigid_fit(std::span<const Point> source, std::span<const Point> target,
                                                 std::span<const double> weights = {});

/// A share of the points' extent along their line: below it a degree of noise turns about the line freely.
inline constexpr double thinnest_ratio_of_rigid_fit = 1e-3;

}  // namespace mimik::geometry
