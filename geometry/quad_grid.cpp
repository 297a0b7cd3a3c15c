#include "geometry/quad_grid.h"

#include <array>

namespace mimik::geometry {

Faces quads(const QuadGrid& grid, BridgedVertices bridged) {
    const auto usable = [&](std::uint32_t v) {
        return bridged == BridgedVertices::keep ? grid.inside(v) : grid.measured(v);
    };
    Faces faces;
    for (int row = 0; row + 1 < grid.rows; ++row)
        for (int col = 0; col + 1 < grid.cols; ++col) {
            const std::array quad = {grid.index(row, col), grid.index(row, col + 1), grid.index(row + 1, col + 1),
                                     grid.index(row + 1, col)};
            if (usable(quad[0]) && usable(quad[1]) && usable(quad[2]) && usable(quad[3])) faces.add(quad);
        }
    return faces;
}

std::vector<Triangle> triangles(const QuadGrid& grid, BridgedVertices bridged) {
    return triangulate(quads(grid, bridged));
}

}  // namespace mimik::geometry
