#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "animation/animate.h"
#include "geometry/mesh.h"

namespace mimik::animation {

/// Which faces a motion tears. Between lids, and between lid and eyeball: each for itself (torn_lids). Between lips:
/// where they part by more than one and a half millimetres, and from there on along the mouth as long as they part by
/// more than half a millimetre. A mouth that opens is one opening with two pointed ends; a threshold per face would
/// leave skin between its lips wherever the motion falls a little below it.
/// @param faces     corners are vertices of the animated surface
/// @param field_mm  per vertex of that surface: the whole motion, or that of one shape
/// @return 1 per torn face
[[nodiscard]] std::vector<std::uint8_t> torn_faces(const AnimatedFace& animated,
                                                   std::span<const geometry::Vector> field_mm,
                                                   const geometry::Faces& faces);

/// The same, of the motion as it is set or of any shape alone: morph targets can be moved to any magnitude.
[[nodiscard]] std::vector<std::uint8_t> torn_faces_of_any_shape(const AnimatedFace& animated,
                                                                const geometry::Faces& faces);

}  // namespace mimik::animation
