#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"

namespace mimik::animation {

/// What is seen between lips or lids that part: the inside of a mouth, as figures, videos and morph targets show it.
inline constexpr std::array<std::uint8_t, 3> inside_colour = {74, 44, 42};

/// A surface that opens without a hole and without a web: what a motion tears is cut half way, and a dark inside lies
/// between the halves.
struct OpenableSurface {
    geometry::Mesh mesh;
    std::vector<std::uint32_t> moves_with;  ///< per vertex: the vertex of the surface asked about that it moves with
    std::size_t skin_vertices = 0;          ///< those from here on are of the dark inside
};

/// Cuts faces between corners of different sheets, at the middle of their edges. At rest the halves meet, so that the
/// surface is as it was; where the sheets part, the dark is seen between them. It lies a millimetre behind, so that it
/// stays hidden where they press together.
/// @param mesh   vertices, faces and texture coordinates one per vertex, or none; the vertices stay, in their order,
/// and
///               new ones follow. Attributes of new vertices are those of the vertex that they move with.
/// @param is_torn  per face
/// @param sheet    per vertex: corners of one sheet stay together
[[nodiscard]] OpenableSurface open_between_sheets(const geometry::Mesh& mesh, std::span<const std::uint8_t> is_torn,
                                                  std::span<const std::uint32_t> sheet);

/// A surface as it is, that opens between two lines of its vertices: lips that are apart already, as those of a
/// template.
/// @param upper, lower  from corner to corner, as many vertices; the ends may be common
[[nodiscard]] OpenableSurface open_between_lines(const geometry::Mesh& mesh, std::span<const std::uint32_t> upper,
                                                 std::span<const std::uint32_t> lower);

/// Colours of the vertices: skin, then the dark inside.
void colour_inside(OpenableSurface& surface, const std::array<std::uint8_t, 3>& skin);

}  // namespace mimik::animation
