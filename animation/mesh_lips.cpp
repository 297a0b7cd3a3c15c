#include "animation/mesh_lips.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>

namespace mimik::animation {

using geometry::Point;
using preprocessing::LipSide;

std::vector<LipSide> lip_sides_along(std::span<const Point> vertices_mm, std::span<const geometry::Triangle> triangles,
                                     std::span<const double> shares) {
    constexpr double sure_share = 2.0 / 3.0;  // 4 of the 12 mm over which a share falls to 0
    // By the mesh alone: vertices at one place can be those of two lips that touch.
    std::vector<std::vector<std::uint32_t>> neighbours(vertices_mm.size());
    for (const auto& t : triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto a = t[c], b = t[(c + 1) % 3];
            if (shares[a] == 0 || shares[b] == 0) continue;
            neighbours[a].push_back(b);
            neighbours[b].push_back(a);
        }
    std::vector<LipSide> sides(vertices_mm.size(), LipSide::neither);
    using Reached = std::tuple<double, std::uint32_t, LipSide>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    for (std::uint32_t v = 0; v < vertices_mm.size(); ++v)
        if (shares[v] != 0 && std::abs(shares[v]) <= sure_share)
            queue.emplace(0.0, v, shares[v] > 0 ? LipSide::upper : LipSide::lower);
    while (!queue.empty()) {
        const auto [reached_mm, v, side] = queue.top();
        queue.pop();
        if (sides[v] != LipSide::neither) continue;
        sides[v] = side;
        for (const auto other : neighbours[v])
            if (sides[other] == LipSide::neither)
                queue.emplace(reached_mm + (vertices_mm[other] - vertices_mm[v]).norm(), other, side);
    }
    for (std::uint32_t v = 0; v < vertices_mm.size(); ++v)
        if (shares[v] != 0 && sides[v] == LipSide::neither)  // a part of its own, as a tooth: the nearest lip
            sides[v] = shares[v] > 0 ? LipSide::upper : LipSide::lower;
    return sides;
}

std::vector<LipSide> evened_lip_sides(std::span<const LipSide> sides, const geometry::GridShape& grid) {
    constexpr int aside = 3, beside = 1;
    const auto [rows, cols] = grid;
    const auto at = [&](int row, int col) {
        return sides[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
    };
    std::vector<LipSide> evened(sides.begin(), sides.end());
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            if (at(row, col) == LipSide::neither) continue;
            int upper = 0, lower = 0;
            for (int r = std::max(0, row - beside); r <= std::min(rows - 1, row + beside); ++r)
                for (int c = std::max(0, col - aside); c <= std::min(cols - 1, col + aside); ++c) {
                    upper += at(r, c) == LipSide::upper ? 1 : 0;
                    lower += at(r, c) == LipSide::lower ? 1 : 0;
                }
            if (upper != lower)
                evened[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)] =
                    upper > lower ? LipSide::upper : LipSide::lower;
        }
    return evened;
}

}  // namespace mimik::animation
