#pragma once

#include <memory>
#include <span>

#include "evaluation/estimator.h"

namespace mimik::evaluation {

/// Skin that holds still, parallel to the vectors: the true motion is below 2 % of its largest on this face.
[[nodiscard]] geometry::VertexMask still_by_truth(std::span<const geometry::Vector> true_displacement_mm);

/// The same without a truth, parallel to `target.vertices`: the real scan shows that nothing moved. Doing nothing is
/// within 0.3 mm at the vertex, and on the mean of all that lie within 7 mm of it, and the zone is 20 mm away or more:
/// skin that slides along itself lies on the real scan, too. Empty: the surface is no gridded face.
[[nodiscard]] geometry::VertexMask still_by_scans(const geometry::FaceSurface& neutral, const ScoredTarget& target);

/// "still_skin": region "face", metric "mean": mean length of the motion of skin that should hold still
/// (ScoredTarget::still), mm. Nothing where no skin is known to.
[[nodiscard]] std::unique_ptr<const Estimator> still_skin_estimator();

}  // namespace mimik::evaluation
