#pragma once

#include "geometry/landmarks.h"

namespace mimik::facs {

/// A mean adult face that catalogues are checked on: the 22 landmarks, symmetric, upright, nose tip at the origin, mm.
/// Rounded from the mean of ICT-FaceKit (MIT licence), whose distances are those of an adult (eye corners 89 mm apart).
[[nodiscard]] const geometry::Landmarks& reference_landmarks();

/// Whether a scan of that face shows the place, seen from the front: an ellipse from chin rim to hairline, ear to ear.
[[nodiscard]] bool on_reference_face(const geometry::Point& position_mm);

}  // namespace mimik::facs
