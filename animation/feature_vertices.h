#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "animation/prepared_target.h"
#include "geometry/types.h"
#include "preprocessing/face_template.h"

namespace mimik::animation {

/// Where the features that video follows lie on a face: its own vertices.
struct FeatureVertices {
    std::vector<std::string> names;       ///< capture::face_features(), in their order, those that could be placed
    std::vector<std::uint32_t> vertices;  ///< per name
    std::vector<std::string> remarks;     ///< what was guessed or left out
};

/// Corners, brows, nose and middles of lips from the landmarks, lids from their margins (lid_margins), the rest between
/// them: lips on parabolas from their middle to the corners.
/// @param lip_sides  per vertex, as AnimatedFace has them, so that inner lips do not change sides; empty: not known
[[nodiscard]] FeatureVertices feature_vertices(const PreparedTarget& target,
                                               std::span<const preprocessing::LipSide> lip_sides);

/// Turns positions of the target into the head's frame: millimetres of the target, origin in the middle between the
/// outer eye corners at rest, axes those of the average face.
[[nodiscard]] geometry::Transform head_from_target(const PreparedTarget& target);

}  // namespace mimik::animation
