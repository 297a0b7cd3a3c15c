#pragma once

#include <cmath>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::test {

/// A bulging sheet of 11 x 9 vertices, 2 mm apart, cut along the middle of its middle row as lips are: upper and lower
/// vertices of the cut lie at the same places.
struct SlitSheet {
    static constexpr int columns = 11, rows = 9, slit_row = 4, slit_begin = 3, slit_end = 7;
    std::vector<geometry::Point> rest_mm;
    std::vector<geometry::Triangle> triangles;
    std::vector<std::uint32_t> rim;    ///< without the cut
    std::vector<std::uint32_t> lower;  ///< the second vertices of the cut, between its ends

    SlitSheet() {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                if (row == 0 || column == 0 || row + 1 == rows || column + 1 == columns)
                    rim.push_back(static_cast<std::uint32_t>(rest_mm.size()));
                rest_mm.push_back(place(row, column));
            }
        for (int column = slit_begin + 1; column < slit_end; ++column) {
            lower.push_back(static_cast<std::uint32_t>(rest_mm.size()));
            rest_mm.push_back(place(slit_row, column));
        }
        for (int row = 0; row + 1 < rows; ++row)
            for (int column = 0; column + 1 < columns; ++column) {
                const auto a = vertex(row, column, row), b = vertex(row, column + 1, row);
                const auto c = vertex(row + 1, column + 1, row), d = vertex(row + 1, column, row);
                triangles.push_back({a, b, c});
                triangles.push_back({a, c, d});
            }
    }

    /// The lower side of the cut is the far end of the rows below it.
    [[nodiscard]] bool below(std::uint32_t v) const {
        return v >= static_cast<std::uint32_t>(rows * columns) || v < static_cast<std::uint32_t>(slit_row * columns);
    }
    /// The lips part by 2 mm, and everything bulges a little.
    [[nodiscard]] std::vector<geometry::Vector> parting_mm() const {
        std::vector<geometry::Vector> motion;
        for (std::uint32_t v = 0; v < rest_mm.size(); ++v) {
            const auto& p = rest_mm[v];
            const double near = std::exp(-(p - place(slit_row, (slit_begin + slit_end) / 2)).squaredNorm() / 20);
            motion.emplace_back(0.1 * near * p.x(), (below(v) ? -near : near), 0.3 * near);
        }
        return motion;
    }

private:
    static geometry::Point place(int row, int column) {
        const double x = 2.0 * column - 10, y = 2.0 * row - 8;
        return {x, y, 6 - 0.03 * x * x - 0.05 * y * y + 0.2 * std::sin(x)};
    }
    static std::uint32_t vertex(int row, int column, int of_row) {
        if (row == slit_row && of_row == slit_row - 1 && column > slit_begin && column < slit_end)
            return static_cast<std::uint32_t>(rows * columns + column - slit_begin - 1);
        return static_cast<std::uint32_t>(row * columns + column);
    }
};

}  // namespace mimik::test
