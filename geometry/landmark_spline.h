#pragma once

#include "geometry/landmarks.h"
#include "geometry/thin_plate_spline.h"

namespace mimik::geometry {

/// The spline through the landmarks that both sets have, paired by name. Two landmarks on one point (closed lips: inner
/// upper and inner lower lip snapped to one vertex) would make the system singular: they count as one, whose target is
/// the mean of theirs.
/// @throws InputError, NumericalError as ThinPlateSpline::fit.
[[nodiscard]] ThinPlateSpline landmark_spline(const Landmarks& source, const Landmarks& target,
                                              const ThinPlateSplineOptions& options = {});

}  // namespace mimik::geometry
