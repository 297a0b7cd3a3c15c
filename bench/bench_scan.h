#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "geometry/quad_grid.h"
#include "geometry/range_scan.h"

namespace mimik::bench {

/// Height of a face-like surface, mm: head, nose, eye sockets, lips.
inline double face_height(double x, double y) {
    const auto bump = [&](double cx, double cy, double wx, double wy) {
        const double dx = (x - cx) / wx, dy = (y - cy) / wy;
        return std::exp(-0.5 * (dx * dx + dy * dy));
    };
    return 90.0 * bump(0, 0, 60, 90) + 22.0 * bump(0, -5, 9, 16) - 9.0 * (bump(-32, 28, 12, 9) + bump(32, 28, 12, 9)) +
           4.0 * (bump(0, -38, 18, 4) + bump(0, -48, 16, 4));
}

/// The work of one Bosphorus scan: about 35,000 valid points inside an oval on a 0.82 mm lattice, noise, holes at eyes
/// and nostrils. `jitter_mm` moves points in x and y (0: exact lattice).
inline geometry::RangeScan make_scan(double jitter_mm, std::uint64_t seed = 1) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0; };
    geometry::RangeScan scan;
    scan.rows = 256;
    scan.cols = 180;
    for (int r = 0; r < scan.rows; ++r)
        for (int c = 0; c < scan.cols; ++c) {
            const double x = 0.82 * (c - 89.5) + jitter_mm * uniform(), y = 0.82 * (r - 127.5) + jitter_mm * uniform();
            const auto in = [&](double cx, double cy, double rx, double ry) {
                return std::hypot((x - cx) / rx, (y - cy) / ry) < 1.0;
            };
            const bool hole = in(-30, 28, 5, 2.5) || in(30, 28, 5, 2.5) || in(-5, -16, 2, 2) || in(5, -16, 2, 2);
            constexpr double nan = std::numeric_limits<double>::quiet_NaN();
            if (!in(0, 0, 73, 104) || hole)
                scan.points_mm.emplace_back(nan, nan, nan);
            else
                scan.points_mm.emplace_back(x, y, face_height(x, y) + 0.2 * uniform());
        }
    return scan;
}

struct Surface {
    std::vector<geometry::Point> vertices_mm;
    std::vector<geometry::Triangle> triangles;
};

/// 150 x 150 vertices, 44,402 triangles, 0.94 x 1.35 mm cells as on a thesis grid; `smile_mm` moves the cheeks.
inline Surface make_surface(std::uint64_t seed, double smile_mm) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0; };
    geometry::QuadGrid grid;
    grid.rows = grid.cols = 150;
    for (int r = 0; r < 150; ++r)
        for (int c = 0; c < 150; ++c) {
            const double x = 0.94 * (c - 74.5), y = 1.35 * (r - 74.5);
            const double push =
                smile_mm * std::exp(-(std::pow((std::abs(x) - 35) / 20, 2) + std::pow((y + 30) / 25, 2)));
            grid.vertices_mm.emplace_back(x + 0.5 * push, y + 0.5 * push, face_height(x, y) + push + 0.15 * uniform());
        }
    grid.origin.assign(grid.vertices_mm.size(), geometry::VertexOrigin::measured);
    return {grid.vertices_mm, geometry::triangles(grid)};
}

}  // namespace mimik::bench
