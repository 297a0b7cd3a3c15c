#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/types.h"

namespace mimik::io {

/// The frames that 3D Slicer states in its files: +x to the patient's left and +y to the back, or +x to the right and
/// +y to the front; +z up in both. They differ by the signs of x and y. A file without a statement is LPS for Slicer.
enum class BodyFrame { lps, ras };
[[nodiscard]] const char* to_string(BodyFrame frame);  ///< "LPS", "RAS"
[[nodiscard]] BodyFrame other_frame(BodyFrame frame);
/// "LPS", "RAS", case ignored; "0" is RAS and "1" LPS, as old .fcsv files say. @throws InputError that begins with the
/// value
[[nodiscard]] BodyFrame parse_body_frame(std::string_view text);

/// The frame of "SPACE=RAS" in a comment or header, as Slicer writes it into its meshes; nothing where there is none.
/// @throws InputError naming `file` where it is a frame of the body that is not read ("SPACE=LAS").
[[nodiscard]] std::optional<BodyFrame> frame_in_comment(std::string_view comment, const std::string& file);

/// Between LPS and RAS, either way.
void negate_x_and_y(std::span<geometry::Point> points);

/// Mean distance of points, each multiplied by `factors`, to the nearest of `mesh_points`; some 200 of the points
/// spread over the list stand for all.
[[nodiscard]] double mean_distance_to(std::span<const geometry::Point> mesh_points,
                                      std::span<const geometry::Point> points, const geometry::Point& factors);

/// The frame of a mesh that states none, judged by points on it whose place in LPS is known: the frame in which they
/// lie on it, at a mean distance to its nearest point of at most 5 % of its diagonal and less than half of the other's.
/// Nothing where neither is so. Points of the mesh that are not finite are passed over.
[[nodiscard]] std::optional<BodyFrame> frame_judged_by(std::span<const geometry::Point> points_lps,
                                                       std::span<const geometry::Point> mesh_points);

}  // namespace mimik::io
