#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mimik::geometry {

/// A position in millimetres. The frame everywhere: +x the subject's left, +y up, +z out of the face.
using Point = Eigen::Vector3d;
/// A difference of two positions, or a direction.
using Vector = Eigen::Vector3d;
/// Texture position, both in [0, 1]: u to the right of the image, v UP from its bottom edge (OBJ, PLY and VTK way).
using TextureCoordinate = Eigen::Vector2d;
/// Named target_from_source, so that `average_from_scan * scan_point` reads right.
using Transform = Eigen::Affine3d;

}  // namespace mimik::geometry
