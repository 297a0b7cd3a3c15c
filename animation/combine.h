#pragma once

#include <span>

#include "geometry/types.h"

namespace mimik::animation {

/// Resultant of contractions that pull one point at the same time, after Bui's idea of simulating their parallelism:
///     R = sum_j |d_j| d_j / sum_j |d_j|
/// Each pull counts by its own strength. R lies in the convex hull of the pulls: one pull alone is itself, two equal
/// pulls do not double, opposite equal pulls cancel, and a pull that fades to nothing fades from R.
[[nodiscard]] geometry::Vector parallel_resultant(std::span<const geometry::Vector> pulls);

}  // namespace mimik::animation
