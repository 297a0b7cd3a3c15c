#include "geometry/quad_grid.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace mimik::geometry {
namespace {

bool usable(const QuadGrid& grid, std::uint32_t v, BridgedVertices bridged) {
    return bridged == BridgedVertices::keep ? grid.inside(v) : grid.measured(v);
}

}  // namespace

Faces quads(const QuadGrid& grid, BridgedVertices bridged) {
    Faces faces;
    for (int row = 0; row + 1 < grid.rows; ++row)
        for (int col = 0; col + 1 < grid.cols; ++col) {
            const std::array quad = {grid.index(row, col), grid.index(row, col + 1), grid.index(row + 1, col + 1),
                                     grid.index(row + 1, col)};
            if (std::all_of(quad.begin(), quad.end(), [&](std::uint32_t v) { return usable(grid, v, bridged); }))
                faces.add(quad);
        }
    return faces;
}

std::vector<Triangle> triangles(const QuadGrid& grid, BridgedVertices bridged) {
    return triangulate(quads(grid, bridged));
}

Mesh to_mesh(const QuadGrid& grid, BridgedVertices bridged, std::vector<std::uint32_t>* kept_vertices) {
    Mesh mesh;
    VertexAttribute origin{"origin", 1, {}};
    std::vector<std::uint32_t> kept, place(grid.size(), std::numeric_limits<std::uint32_t>::max());
    mesh.faces = quads(grid, bridged);
    std::vector<char> used(grid.size(), 0);
    for (const auto corner : mesh.faces.corners) used[corner] = 1;
    for (std::uint32_t v = 0; v < grid.size(); ++v) {
        if (!used[v]) continue;
        place[v] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(v);
        mesh.vertices_mm.push_back(grid.vertices_mm[v]);
        origin.values.push_back(static_cast<double>(grid.origin[v]));
        if (!grid.texture_coordinates.empty()) mesh.texture_coordinates.push_back(grid.texture_coordinates[v]);
    }
    for (auto& corner : mesh.faces.corners) corner = place[corner];
    mesh.attributes.push_back(std::move(origin));
    if (kept_vertices) *kept_vertices = std::move(kept);
    return mesh;
}

}  // namespace mimik::geometry
