#pragma once

#include <cstdint>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::geometry {

/// What stands behind a vertex of a resampled face.
enum class VertexOrigin : std::uint8_t {
    outside = 0,   ///< outside the hull of the data: position is NaN in z
    measured = 1,  ///< interpolated between measured points that are close together
    bridged = 2,   ///< interpolated across a hole: not a measurement
};

/// A face resampled to a regular x-y grid (the thesis: 150 x 150). Row 0 is the lowest row; x grows with the column.
struct QuadGrid {
    int rows = 0;
    int cols = 0;
    std::vector<Point> vertices_mm;                      ///< [row * cols + col]
    std::vector<VertexOrigin> origin;                    ///< one per vertex
    std::vector<TextureCoordinate> texture_coordinates;  ///< empty, or one per vertex

    [[nodiscard]] std::size_t size() const { return vertices_mm.size(); }
    [[nodiscard]] std::uint32_t index(int row, int col) const { return static_cast<std::uint32_t>(row * cols + col); }
    [[nodiscard]] bool measured(std::size_t vertex) const { return origin[vertex] == VertexOrigin::measured; }
    [[nodiscard]] bool inside(std::size_t vertex) const { return origin[vertex] != VertexOrigin::outside; }
};

enum class BridgedVertices { keep, leave_out };
[[nodiscard]] constexpr const char* to_string(BridgedVertices bridged) {
    return bridged == BridgedVertices::keep ? "keep" : "leave_out";
}

/// The quads whose four corners are inside (and measured, if bridged ones are left out), counter-clockwise seen from
/// the camera. Corner indices are grid indices.
[[nodiscard]] Faces quads(const QuadGrid& grid, BridgedVertices bridged = BridgedVertices::keep);

/// The same quads, each split along its diagonal from (row, col) to (row + 1, col + 1).
[[nodiscard]] std::vector<Triangle> triangles(const QuadGrid& grid, BridgedVertices bridged = BridgedVertices::keep);

/// The quads of quads() and the vertices that they use, in grid order (one that no quad uses is no surface): texture
/// coordinates and the attribute `origin` (1 measured, 2 bridged) go along.
/// @param kept_vertices  grid index of every vertex of the mesh
[[nodiscard]] Mesh to_mesh(const QuadGrid& grid, BridgedVertices bridged = BridgedVertices::keep,
                           std::vector<std::uint32_t>* kept_vertices = nullptr);

}  // namespace mimik::geometry
