#include "preprocessing/gridding.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "geometry/delaunay.h"
#include "tests/support/analytic_face.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::QuadGrid;
using geometry::RangeScan;
using geometry::VertexOrigin;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double face(double x, double y) {
    return 60.0 * std::exp(-(x * x / 3000 + y * y / 6000)) + 25.0 * std::exp(-(x * x / 100 + y * y / 200));
}

// A lattice of 0.8 mm; `jitter_mm` moves every point in x and y.
template <typename Height>
RangeScan lattice(int rows, int cols, double jitter_mm, Height height) {
    std::mt19937_64 engine(1);
    const auto noise = [&] { return jitter_mm * (2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0); };
    RangeScan scan;
    scan.rows = rows;
    scan.cols = cols;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < cols; ++c) {
            const double x = 0.8 * (c - 0.5 * (cols - 1)) + noise(), y = 0.8 * (r - 0.5 * (rows - 1)) + noise();
            scan.points_mm.emplace_back(x, y, height(x, y));
        }
    return scan;
}

void cut_hole(RangeScan& scan, double x, double y, double radius_mm) {
    for (auto& p : scan.points_mm)
        if (std::hypot(p.x() - x, p.y() - y) < radius_mm) p = Point(nan, nan, nan);
}

std::size_t count(const QuadGrid& grid, VertexOrigin origin) {
    return static_cast<std::size_t>(std::count(grid.origin.begin(), grid.origin.end(), origin));
}

class BothWays : public testing::TestWithParam<bool> {
protected:
    static GriddingOptions options() {
        GriddingOptions o;
        o.rows = 60;
        o.cols = 50;
        o.use_lattice = GetParam();
        return o;
    }
};
INSTANTIATE_TEST_SUITE_P(Gridding, BothWays, testing::Values(true, false),
                         [](const auto& each) { return each.param ? "lattice" : "delaunay"; });

TEST_P(BothWays, a_plane_is_reproduced_exactly_bridged_or_not) {
    const auto plane = [](double x, double y) { return 7.0 + 0.3 * x - 0.2 * y; };
    auto scan = lattice(90, 80, 0.0, plane);
    for (const auto& p : scan.points_mm) scan.texture_coordinates.emplace_back(0.5 + p.x() / 100, 0.5 - p.y() / 100);
    cut_hole(scan, 3, 4, 6);
    cut_hole(scan, -32, -36, 9);  // a corner: a concavity
    GriddingReport report;
    const auto grid = grid_scan(scan, options(), &report);
    EXPECT_GT(report.bridged, 0U);
    EXPECT_GT(report.outside, 0U);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const auto& p = grid.vertices_mm[v];
        if (!grid.inside(v)) {
            EXPECT_TRUE(std::isnan(p.z()));
            EXPECT_TRUE(std::isnan(grid.texture_coordinates[v].x()));
            continue;
        }
        EXPECT_NEAR(p.z(), plane(p.x(), p.y()), 1e-12);  // linear interpolation of a linear function: rounding alone
        EXPECT_NEAR(grid.texture_coordinates[v].x(), 0.5 + p.x() / 100, 1e-14);
        EXPECT_NEAR(grid.texture_coordinates[v].y(), 0.5 - p.y() / 100, 1e-14);
    }
}

TEST_P(BothWays, the_grid_is_the_linspace_of_the_bounding_box_and_its_rim_is_inside) {
    const auto scan = lattice(40, 30, 0.0, face);
    GriddingReport report;
    const auto grid = grid_scan(scan, options(), &report);
    EXPECT_EQ(grid.rows, 60);
    EXPECT_EQ(grid.cols, 50);
    EXPECT_EQ(grid.vertices_mm.front().head<2>(), scan.points_mm.front().head<2>());
    EXPECT_EQ(grid.vertices_mm.back().head<2>(), scan.points_mm.back().head<2>());
    EXPECT_NEAR(grid.vertices_mm[1].x() - grid.vertices_mm[0].x(), 0.8 * 29 / 49, 1e-14);  // 12 mm has an ulp of 2e-15
    EXPECT_EQ(report.measured, grid.size());  // corners and edges of a rectangular hull too
    EXPECT_EQ(report.outside + report.bridged, 0U);
}

TEST_P(BothWays, a_vertex_that_meets_a_point_has_its_height) {
    const auto scan = lattice(60, 50, 0.0, face);
    const auto grid = grid_scan(scan, options());
    for (std::size_t v = 0; v < grid.size(); ++v) EXPECT_NEAR(grid.vertices_mm[v].z(), scan.points_mm[v].z(), 1e-11);
}

TEST_P(BothWays, a_hole_is_bridged_and_every_vertex_in_it_knows) {
    auto scan = lattice(90, 80, 0.05, face);
    cut_hole(scan, 5, -8, 6);
    GriddingReport report;
    const auto grid = grid_scan(scan, options(), &report);
    EXPECT_EQ(report.measured, count(grid, VertexOrigin::measured));
    EXPECT_EQ(report.bridged, count(grid, VertexOrigin::bridged));
    EXPECT_EQ(report.outside, count(grid, VertexOrigin::outside));
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const auto& p = grid.vertices_mm[v];
        const double from_hole = std::hypot(p.x() - 5, p.y() + 8);
        const bool at_rim = std::abs(p.x()) > 30.5 || std::abs(p.y()) > 34.5;
        // One spacing (0.8, and its diagonal 1.2) on either side of the rim belongs to whichever triangle is there.
        if (from_hole < 6.0 - 1.2) {
            EXPECT_EQ(grid.origin[v], VertexOrigin::bridged) << from_hole;
        } else if (from_hole > 6.0 + 1.2 && !at_rim) {
            EXPECT_EQ(grid.origin[v], VertexOrigin::measured) << from_hole;
        }
    }
}

TEST_P(BothWays, one_lost_point_is_no_hole) {
    auto scan = lattice(90, 80, 0.0, face);
    for (std::size_t r = 10; r < 80; r += 10)
        for (std::size_t c = 10; c < 70; c += 10) scan.points_mm[r * 80 + c] = Point(nan, nan, nan);
    GriddingReport report;
    (void)grid_scan(scan, options(), &report);
    EXPECT_EQ(report.bridged, 0U);
}

TEST_P(BothWays, max_edge_decides_what_is_bridged) {
    auto scan = lattice(90, 80, 0.0, face);
    cut_hole(scan, 0, 0, 4);
    auto o = options();
    o.max_edge_mm = 20.0;
    GriddingReport report;
    (void)grid_scan(scan, o, &report);
    EXPECT_EQ(report.bridged, 0U);
    EXPECT_EQ(report.max_edge_mm, 20.0);
    o.max_edge_mm = 2.4;
    (void)grid_scan(scan, o, &report);
    // A disk of radius 4 less half a spacing, in cells of 63.2/49 x 71.2/59 mm.
    EXPECT_NEAR(static_cast<double>(report.bridged), 3.1416 * 3.8 * 3.8 / (63.2 / 49 * 71.2 / 59), 10.0);
}

// Interpolates in every triangle that holds the vertex, one after the other, in another arithmetic than the raster.
double interpolated(const std::vector<Point>& points, const std::vector<geometry::Triangle>& triangles,
                    const Point& g) {
    for (const auto& t : triangles) {
        Eigen::Matrix<long double, 2, 2> m;
        m.col(0) = (points[t[1]] - points[t[0]]).head<2>().cast<long double>();
        m.col(1) = (points[t[2]] - points[t[0]]).head<2>().cast<long double>();
        const Eigen::Matrix<long double, 2, 1> w = m.inverse() * (g - points[t[0]]).head<2>().cast<long double>();
        if (w.minCoeff() < -1e-12L || w.sum() > 1 + 1e-12L) continue;
        return static_cast<double>((1 - w.sum()) * points[t[0]].z() + w[0] * points[t[1]].z() +
                                   w[1] * points[t[2]].z());
    }
    return nan;
}

TEST(Gridding, points_in_general_position_get_the_delaunay_heights) {
    std::mt19937_64 engine(3);
    const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    RangeScan scan;
    std::vector<Eigen::Vector2d> planar;
    for (int i = 0; i < 700; ++i) {
        scan.points_mm.emplace_back(100 * uniform(), 130 * uniform(), 40 * uniform());
        planar.emplace_back(scan.points_mm.back().head<2>());
    }
    GriddingOptions options;
    options.rows = 41;
    options.cols = 37;
    GriddingReport report;
    const auto grid = grid_scan(scan, options, &report);
    EXPECT_EQ(report.method, GriddingMethod::delaunay);
    const auto triangles = geometry::delaunay(planar);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const double expected = interpolated(scan.points_mm, triangles, grid.vertices_mm[v]);
        EXPECT_EQ(std::isnan(expected), !grid.inside(v)) << v;
        // Thin triangles at the hull lose a few digits of the 1e-14 elsewhere.
        if (grid.inside(v)) {
            EXPECT_NEAR(grid.vertices_mm[v].z(), expected, 1e-9) << v;
        }
    }
}

TEST(Gridding, a_noisy_lattice_gives_the_same_face_cell_by_cell_as_by_delaunay) {
    auto scan = lattice(200, 170, 0.05, face);
    cut_hole(scan, 20, 30, 5);
    cut_hole(scan, -60, -70, 25);
    cut_hole(scan, 70, 10, 12);
    GriddingOptions cells, all;
    all.use_lattice = false;
    GriddingReport report;
    const auto one = grid_scan(scan, cells, &report), other = grid_scan(scan, all);
    EXPECT_EQ(report.method, GriddingMethod::lattice);
    std::size_t differ = 0, origins = 0;
    for (std::size_t v = 0; v < one.size(); ++v) {
        EXPECT_EQ(one.inside(v), other.inside(v)) << v;
        differ += one.inside(v) && std::abs(one.vertices_mm[v].z() - other.vertices_mm[v].z()) > 1e-9 ? 1 : 0;
        origins += one.origin[v] != other.origin[v] ? 1 : 0;
    }
    // The diagonals of the cells are Delaunay's; only a few sides of cells on the outer border may not be.
    EXPECT_LT(differ, one.size() / 500);
    EXPECT_LT(origins, one.size() / 500);
}

TEST(Gridding, a_mirrored_lattice_gives_the_same_grid) {
    const auto scan = lattice(60, 50, 0.05, face);
    auto flipped = scan;
    for (std::size_t r = 0; r < 60; ++r)
        for (std::size_t c = 0; c < 50; ++c) flipped.points_mm[(59 - r) * 50 + c] = scan.points_mm[r * 50 + c];
    const auto one = grid_scan(scan), other = grid_scan(flipped);
    for (std::size_t v = 0; v < one.size(); ++v) {
        EXPECT_EQ(one.origin[v], other.origin[v]);
        if (one.inside(v)) {
            EXPECT_NEAR(one.vertices_mm[v].z(), other.vertices_mm[v].z(), 1e-11);
        }
    }
}

TEST(Gridding, where_the_lattice_folds_over_the_nearest_sheet_counts) {
    // A cliff at x = 0 that leans over by 3 mm: the upper sheet reaches out to x = 3 over the lower one.
    RangeScan scan;
    scan.rows = 30;
    scan.cols = 40;
    for (int r = 0; r < 30; ++r)
        for (int c = 0; c < 40; ++c) scan.points_mm.emplace_back(c < 20 ? c - 16.6 : c - 20, r, c < 20 ? 10.0 : 0.0);
    GriddingOptions options;
    options.rows = 30;
    options.cols = 73;
    options.max_edge_mm = 4.0;
    GriddingReport report;
    const auto grid = grid_scan(scan, options, &report);
    EXPECT_EQ(report.folded_triangles, 2U * 29);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const auto& p = grid.vertices_mm[v];
        EXPECT_NEAR(p.z(), p.x() <= 2.4 ? 10.0 : 0.0, 1e-12) << p.x();
    }
}

/// The face in closed form, and behind it the back of the head, joined as one mesh; some files wind it the other way.
RangeScan head(bool turned) {
    using Face = test::AnalyticFace;
    const auto front = Face{}.mesh(Face::lines(-60, 60, 2), Face::lines(-60, 60, 2));
    RangeScan head = front;
    const auto count = static_cast<std::uint32_t>(front.points_mm.size());
    for (const auto& p : front.points_mm) head.points_mm.emplace_back(p.x() + 0.3, p.y() + 0.4, -150 - p.z());
    for (std::size_t f = 0; f < front.faces.size(); ++f) {
        std::vector<std::uint32_t> back;
        for (const auto v : front.faces[f]) back.push_back(v + count);
        head.faces.add(back);
    }
    if (!turned) return head;
    geometry::Faces faces;
    for (std::size_t f = 0; f < head.faces.size(); ++f) {
        std::vector<std::uint32_t> corners(head.faces[f].rbegin(), head.faces[f].rend());
        faces.add(corners);
    }
    head.faces = faces;
    return head;
}

TEST(Gridding, of_a_head_with_a_back_the_face_is_seen_whatever_the_winding) {
    for (const bool turned : {false, true}) {
        const auto scan = head(turned);
        GriddingReport report;
        const auto grid = grid_scan(scan, {}, &report);
        EXPECT_EQ(report.method, GriddingMethod::mesh);
        std::size_t compared = 0;
        for (std::size_t v = 0; v < grid.size(); ++v) {
            const auto& p = grid.vertices_mm[v];
            if (std::abs(p.x()) > 59 || std::abs(p.y()) > 59) continue;
            ++compared;
            ASSERT_EQ(grid.origin[v], geometry::VertexOrigin::measured) << p.transpose();
            // Linear interpolation over 2 mm: h^2 / 8 times the curvature, at most 2 / 1.5^2 per mm between the lips,
            // and the diagonal adds as much again.
            ASSERT_NEAR(p.z(), test::AnalyticFace::depth(p.x(), p.y()), 0.9) << p.transpose();
        }
        EXPECT_GT(compared, 20'000U);
    }
}

TEST(Gridding, through_an_opening_in_a_mesh_the_inside_of_the_head_is_not_measured) {
    for (const bool turned : {false, true}) {
        auto scan = head(turned);
        // Openings for both eyes; behind the one on the left a socket 30 mm deep, itself open towards the back.
        const auto from_eye = [](const Point& p, double side) { return std::hypot(p.x() - side * 32, p.y() - 35); };
        geometry::Faces faces;
        for (std::size_t f = 0; f < scan.faces.size(); ++f) {
            const Point& p = scan.points_mm[scan.faces[f][0]];
            if (p.z() < -100 || (from_eye(p, 1) > 9 && from_eye(p, -1) > 9)) faces.add(scan.faces[f]);
        }
        const auto count = static_cast<std::uint32_t>(scan.points_mm.size());
        for (int k = 0; k < 16; ++k)
            for (const double radius : {4.0, 12.0})
                scan.points_mm.emplace_back(32 + radius * std::cos(k * 0.3927), 35 + radius * std::sin(k * 0.3927),
                                            -50);
        for (std::uint32_t k = 0; k < 16; ++k) {
            const std::uint32_t i = count + 2 * k, j = count + 2 * ((k + 1) % 16);
            faces.add(std::array<std::uint32_t, 4>{i, i + 1, j + 1, j});
        }
        scan.faces = faces;
        GriddingReport report;
        const auto grid = grid_scan(scan, {}, &report);
        EXPECT_GT(report.pit_vertices, 2U * 200);  // a disk of 8 mm has 250 cells of 0.9 mm
        EXPECT_LT(report.pit_vertices, 2U * 450);
        std::size_t bridged = 0;
        for (std::size_t v = 0; v < grid.size(); ++v) {
            const auto& p = grid.vertices_mm[v];
            if (std::abs(p.x()) > 59 || std::abs(p.y()) > 59) continue;
            bridged += grid.measured(v) ? 0 : 1;
            // Straight across 20 mm of an eye hollow 5 mm deep.
            EXPECT_NEAR(p.z(), test::AnalyticFace::depth(p.x(), p.y()), grid.measured(v) ? 0.9 : 5.0) << p.transpose();
            // Faces whose first corner is 9 mm off and more are there; they reach 2.83 mm inwards.
            if (std::min(from_eye(p, 1), from_eye(p, -1)) < 6) {
                EXPECT_EQ(grid.origin[v], VertexOrigin::bridged) << p.transpose();
            }
        }
        EXPECT_GE(bridged, report.pit_vertices);
    }
}

/// Flat, with an opening of 10 mm radius in the middle, and a disk of 14 mm so far behind it; `ring_mm` is where the
/// flat ends.
RangeScan window(double behind_mm, double ring_mm) {
    RangeScan scan;
    const auto ring = [&](double inner, double outer, double z) {
        const auto first = static_cast<std::uint32_t>(scan.points_mm.size());
        for (int k = 0; k < 40; ++k)
            for (const double radius : {inner, outer})
                scan.points_mm.emplace_back(radius * std::cos(k * 0.15708), radius * std::sin(k * 0.15708), z);
        for (std::uint32_t k = 0; k < 40; ++k) {
            const std::uint32_t i = first + 2 * k, j = first + 2 * ((k + 1) % 40);
            scan.faces.add(std::array<std::uint32_t, 4>{i, i + 1, j + 1, j});
        }
    };
    ring(10, ring_mm, 0);
    ring(0.001, 14, -behind_mm);
    return scan;
}

TEST(Gridding, eyeballs_close_behind_the_lids_and_a_face_in_a_hood_are_no_pits) {
    const auto pits = [](double behind_mm, double ring_mm, int size) {
        GriddingOptions options;
        options.rows = options.cols = size;
        GriddingReport report;
        (void)grid_scan(window(behind_mm, ring_mm), options, &report);
        return report.pit_vertices;
    };
    EXPECT_GT(pits(100, 60, 100), 100U);  // the inside of a head; a disk of 10 mm has 214 cells of 1.2 mm
    EXPECT_EQ(pits(9, 60, 500), 0U);      // six cells of 0.24 mm are much less than 9 mm
    EXPECT_EQ(pits(100, 30, 100), 0U);    // an eighth of the ring is too large for an eye
}

TEST(Gridding, what_stands_in_front_of_a_face_is_no_pit_nor_what_stands_in_front_of_that) {
    RangeScan scan;  // squares before a sheet, a staircase to either side
    const auto square = [&](double x, double y, double z, double half) {
        const auto first = static_cast<std::uint32_t>(scan.points_mm.size());
        for (const auto& [dx, dy] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
            scan.points_mm.emplace_back(x + dx, y + dy, z);
        scan.faces.add(std::array<std::uint32_t, 4>{first, first + 1, first + 2, first + 3});
    };
    square(0, 0, 0, 70);
    for (const double side : {-1.0, 1.0}) {
        square(side * 30, side * 30, 40, 8);
        square(side * 30, side * 30, 80, 5);
        square(side * 30, side * 30, 120, 2.5);
    }
    GriddingReport report;
    const auto grid = grid_scan(scan, {}, &report);
    EXPECT_EQ(report.pit_vertices, 0U);
    EXPECT_EQ(grid.vertices_mm[grid.index(106, 106)].z(), 120);  // 30 mm: (30 + 70) / 140 of 149 rows
}

TEST(Gridding, a_closed_mesh_with_a_slit_has_nothing_to_fill) {
    RangeScan scan;  // a box; one edge of its front is split on one side only
    for (const double z : {-100.0, 0.0})
        for (const double y : {0.0, 20.0})
            for (const double x : {0.0, 20.0}) scan.points_mm.emplace_back(x, y, z);
    scan.points_mm.emplace_back(10, 0, 0);
    using Quad = std::array<std::uint32_t, 4>;
    for (const auto& quad : {Quad{0, 2, 3, 1}, Quad{0, 1, 5, 4}, Quad{2, 6, 7, 3}, Quad{0, 4, 6, 2}, Quad{1, 3, 7, 5}})
        scan.faces.add(quad);
    scan.faces.add(std::array<std::uint32_t, 5>{4, 8, 5, 7, 6});
    GriddingReport report;
    const auto grid = grid_scan(scan, {}, &report);
    EXPECT_EQ(report.rim_points, 3U);
    EXPECT_EQ(report.measured, grid.size());
    for (const auto& p : grid.vertices_mm) EXPECT_EQ(p.z(), 0.0);
}

TEST(Gridding, no_skirt_hangs_from_a_jaw_to_the_neck_behind_it) {
    RangeScan scan;  // two sheets that overlap, 40 mm apart
    scan.points_mm = {{0, 0, 0},   {20, 0, 0},   {20, 12, 0},  {0, 12, 0},
                      {0, 10, 40}, {20, 10, 40}, {20, 20, 40}, {0, 20, 40}};
    scan.faces.add(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    scan.faces.add(std::array<std::uint32_t, 4>{4, 5, 6, 7});
    GriddingOptions options;
    options.rows = options.cols = 21;
    const auto grid = grid_scan(scan, options);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const auto& p = grid.vertices_mm[v];
        EXPECT_EQ(p.z(), p.y() >= 10 ? 40.0 : 0.0) << p.transpose();
        EXPECT_EQ(grid.measured(v), p.y() != 9.0) << p.transpose();  // the last row before the drop
    }
}

TEST(Gridding, a_cloud_that_is_seen_through_says_so) {
    auto scan = head(false);
    scan.faces = {};
    GriddingReport report;
    (void)grid_scan(scan, {}, &report);
    EXPECT_GT(report.seen_through, 0.5);
    scan.points_mm.resize(scan.points_mm.size() / 2);
    (void)grid_scan(scan, {}, &report);
    EXPECT_EQ(report.seen_through, 0.0);
}

TEST(Gridding, what_joins_front_and_back_of_a_cloud_is_not_measured) {
    auto scan = head(false);
    scan.faces = {};
    const std::size_t front = scan.points_mm.size() / 2;
    for (std::size_t i = front; i < scan.points_mm.size(); ++i)
        if (i % 97 != 0) scan.points_mm[i] = Point(nan, nan, nan);
    GriddingReport report;
    const auto grid = grid_scan(scan, {}, &report);
    EXPECT_GT(report.seen_through, 0.02);  // one point of the back in 97 is a corner of 6 of 2 * 97 triangles
    EXPECT_LT(report.seen_through, 0.04);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const auto& p = grid.vertices_mm[v];
        if (std::abs(p.x()) > 59 || std::abs(p.y()) > 59 || !grid.measured(v)) continue;
        ASSERT_NEAR(p.z(), test::AnalyticFace::depth(p.x(), p.y()), 0.9) << p.transpose();
    }
}

TEST(Gridding, points_that_share_x_and_y_are_averaged) {
    RangeScan scan;
    scan.points_mm = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0, 0, 4}, {0, 0, 7}};
    GriddingOptions options;
    options.rows = options.cols = 2;
    GriddingReport report;
    const auto grid = grid_scan(scan, options, &report);
    EXPECT_EQ(report.duplicates, 2U);
    EXPECT_EQ(grid.vertices_mm[0].z(), 4.0);
    EXPECT_EQ(grid.vertices_mm[3].z(), 1.0);
}

TEST(Gridding, bad_options_and_scans_are_refused_by_name) {
    EXPECT_NO_THROW(GriddingOptions{}.check());
    const auto refused = [](auto change, const char* name) {
        GriddingOptions options;
        change(options);
        EXPECT_THAT([&] { options.check(); }, ThrowsMessage<InputError>(HasSubstr(name)));
    };
    refused([](auto& o) { o.rows = 1; }, "1 x 150");
    refused([](auto& o) { o.max_edge_mm = -2.0; }, "max_edge_mm is -2");
    refused([](auto& o) { o.max_edge_spacings = nan; }, "max_edge_spacings");
    RangeScan scan;
    scan.points_mm = {{0, 0, 0}, {1, 1, 0}, {nan, nan, nan}};
    EXPECT_THAT([&] { (void)grid_scan(scan); }, ThrowsMessage<InputError>(HasSubstr("2 valid points")));
    scan.points_mm[2] = Point(2, 2, 0);
    EXPECT_THAT([&] { (void)grid_scan(scan); }, ThrowsMessage<NumericalError>(HasSubstr("line")));
    scan.texture_coordinates.emplace_back(0, 0);
    EXPECT_THAT([&] { (void)grid_scan(scan); }, ThrowsMessage<InputError>(HasSubstr("1 texture coordinates")));
}

}  // namespace
}  // namespace mimik::preprocessing
