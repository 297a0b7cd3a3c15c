#pragma once

#include <span>
#include <vector>

#include "geometry/face_surface.h"
#include "geometry/types.h"
#include "preprocessing/face_template.h"

namespace mimik::animation {

/// On which lip the vertices of somebody's mesh lie. Lips that touch are near each other in space, so the nearest point
/// of a template can be of the wrong one; along a mesh that is open between its lips they are far apart. So those that
/// are surely of one lip, 4 mm and more from the cut, hand it on along the edges to those that are nearer.
/// @param shares  per vertex: preprocessing::lip_shares at its place on the template; 0: of no lip
/// @return per vertex; neither where the share is 0
[[nodiscard]] std::vector<preprocessing::LipSide> lip_sides_along(std::span<const geometry::Point> vertices_mm,
                                                                  std::span<const geometry::Triangle> triangles,
                                                                  std::span<const double> shares);

/// The nearest point of a template is now and then of the wrong lip, so the line between the lips of a scan has single
/// teeth, which would move with the other lip. A vertex of a lip goes to the one that most vertices about it lie on:
/// seven columns wide and three rows high, since the line runs across.
/// @param sides  of the vertices of a grid, row by row
[[nodiscard]] std::vector<preprocessing::LipSide> evened_lip_sides(std::span<const preprocessing::LipSide> sides,
                                                                   const geometry::GridShape& grid);

}  // namespace mimik::animation
