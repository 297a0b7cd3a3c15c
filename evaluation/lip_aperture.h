#pragma once

#include <memory>
#include <optional>

#include "evaluation/estimator.h"

namespace mimik::evaluation {

/// How far apart the inner lips are in the middle of the mouth, along the neutral face's own axis from mouth to eyes.
/// Below 0: they overlap, by what marking errs.
struct LipAperture {
    double animated_mm = 0.0;  ///< of the moved neutral face
    double real_mm = 0.0;      ///< of the real expressive scan, by its landmarks
};

/// The animated one is the gap between the neutral face's inner lips, and what the motions of upper and lower lip add
/// to it. Each is taken from the measured vertex that lies nearest to a point 2 mm from the inner landmark towards the
/// outer one, and at least half as far that way: on closed lips a vertex at the inner landmark could belong to the
/// wrong lip.
/// @return empty: a landmark is missing in one of the scans, or no skin was measured within 3 mm of the place
[[nodiscard]] std::optional<LipAperture> lip_aperture(const JudgedFace& face);

/// "lip_aperture": region "mouth", metrics "animated", "real" and "error" (animated - real), mm.
[[nodiscard]] std::unique_ptr<const Estimator> lip_aperture_estimator();

}  // namespace mimik::evaluation
