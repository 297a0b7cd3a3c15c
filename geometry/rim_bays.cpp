#include "geometry/rim_bays.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace mimik::geometry {
namespace {

/// Bridged vertices that stand in a narrow gap of their row or column: a crack before an ear, say.
std::vector<std::uint8_t> narrow_gaps(const QuadGrid& grid) {
    constexpr int widest = 12;  // vertices: a centimetre or so
    std::vector<std::uint8_t> narrow(grid.size(), 0);
    const auto scan = [&](int lines, int length, const auto& vertex) {
        for (int line = 0; line < lines; ++line) {
            int last = -1;  // measured
            for (int k = 0; k < length; ++k) {
                const auto v = vertex(line, k);
                if (!grid.inside(v)) last = -1;
                if (!grid.measured(v)) continue;
                if (last >= 0 && k - last - 1 <= widest)
                    for (int gap = last + 1; gap < k; ++gap) narrow[vertex(line, gap)] = 1;
                last = k;
            }
        }
    };
    scan(grid.rows, grid.cols, [&](int row, int col) { return grid.index(row, col); });
    scan(grid.cols, grid.rows, [&](int col, int row) { return grid.index(row, col); });
    return narrow;
}

}  // namespace

QuadGrid without_rim_bays(QuadGrid grid) {
    const auto narrow = narrow_gaps(grid);
    const auto neighbours = [&](std::uint32_t v) {
        const int row = static_cast<int>(v) / grid.cols, col = static_cast<int>(v) % grid.cols;
        std::array<std::int64_t, 4> all = {-1, -1, -1, -1};  // -1: beyond the grid
        if (row > 0) all[0] = grid.index(row - 1, col);
        if (row + 1 < grid.rows) all[1] = grid.index(row + 1, col);
        if (col > 0) all[2] = grid.index(row, col - 1);
        if (col + 1 < grid.cols) all[3] = grid.index(row, col + 1);
        return all;
    };
    const auto outside = [&](std::int64_t v) { return v < 0 || !grid.inside(static_cast<std::size_t>(v)); };
    std::vector<std::uint32_t> open;
    for (std::uint32_t v = 0; v < grid.size(); ++v) {
        const auto around = neighbours(v);
        if (grid.origin[v] == VertexOrigin::bridged && std::any_of(around.begin(), around.end(), outside))
            open.push_back(v);
    }
    while (!open.empty()) {
        const auto v = open.back();
        open.pop_back();
        if (grid.origin[v] != VertexOrigin::bridged || narrow[v]) continue;
        grid.origin[v] = VertexOrigin::outside;
        for (const auto other : neighbours(v))
            if (other >= 0) open.push_back(static_cast<std::uint32_t>(other));
    }
    return grid;
}

}  // namespace mimik::geometry
