#pragma once

#include <optional>

#include "geometry/landmarks.h"
#include "geometry/types.h"

namespace mimik::geometry {

/// Between the outer eye corners: the length that hardly changes with an expression, so other lengths on a face are
/// told as shares of it. @throws InputError naming the landmark that is missing.
[[nodiscard]] double outer_eye_distance_mm(const Landmarks& landmarks);
/// Between the mouth corners. @throws InputError naming the landmark that is missing.
[[nodiscard]] double mouth_width_mm(const Landmarks& landmarks);

/// Axes of the head from its landmarks: lateral (to the subject's left), up, out of the face. Empty if eye corners,
/// mouth corners or nose tip are missing.
struct HeadAxes {
    Vector lateral, up, out;
};
[[nodiscard]] std::optional<HeadAxes> head_axes(const Landmarks& landmarks);

}  // namespace mimik::geometry
