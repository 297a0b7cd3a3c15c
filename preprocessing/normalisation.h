#pragma once

#include <array>
#include <string_view>

#include "geometry/landmarks.h"

namespace mimik::preprocessing {

/// The four landmarks of Eqs 5.1-5.4.
inline constexpr std::array<std::string_view, 4> affine_landmarks = {"eye_outer_left", "eye_outer_right", "chin",
                                                                     "nose_tip"};

/// Eqs 5.1-5.4: nose tips to the origin, then T = A B^-1 from the outer eye corners, the chin and the nose tip; the two
/// shifts stand on both sides of T. Exact at the four landmarks; shears, and hides the motion of a chin that moves.
/// @throws InputError if a landmark is missing; NumericalError if the four lie in one plane.
[[nodiscard]] geometry::Transform affine_normalisation(const geometry::Landmarks& landmarks,
                                                       const geometry::Landmarks& average_landmarks);

/// Least-squares similarity (rotation, one scale, translation; Umeyama 1991) through all landmarks that both have.
/// @throws InputError if fewer than three are shared; NumericalError if they lie on one line.
[[nodiscard]] geometry::Transform similarity_normalisation(const geometry::Landmarks& landmarks,
                                                           const geometry::Landmarks& average_landmarks);

/// Least-squares rotation and translation through all landmarks that both have; the start of the ICP.
[[nodiscard]] geometry::Transform rigid_by_landmarks(const geometry::Landmarks& source,
                                                     const geometry::Landmarks& target);

}  // namespace mimik::preprocessing
