#include "remeshing/remesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "remeshing/hausdorff.h"
#include "tests/support/thrown.h"

namespace mimik::remeshing {
namespace {

using geometry::Mesh;
using geometry::Point;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A square of 60 mm in quads of `step_mm`, lifted by z(x, y); the vertices are numbered row by row.
template <class Height>
Mesh patch(double step_mm, const Height& height) {
    Mesh mesh;
    const auto count = static_cast<std::uint32_t>(std::lround(60 / step_mm));
    for (std::uint32_t row = 0; row <= count; ++row)
        for (std::uint32_t col = 0; col <= count; ++col) {
            const double x = -30 + step_mm * col, y = -30 + step_mm * row;
            mesh.vertices_mm.emplace_back(x, y, height(x, y));
        }
    for (std::uint32_t row = 0; row < count; ++row)
        for (std::uint32_t col = 0; col < count; ++col) {
            const auto at = row * (count + 1) + col;
            mesh.faces.add(std::array{at, at + 1, at + count + 2, at + count + 1});
        }
    return mesh;
}
double flat(double, double) { return 0; }
constexpr double radius_mm = 60;
double dome(double x, double y) { return std::sqrt(radius_mm * radius_mm - x * x - y * y); }

double area_of(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& a = mesh.vertices_mm[mesh.faces[f][0]];
        sum += (mesh.vertices_mm[mesh.faces[f][1]] - a).cross(mesh.vertices_mm[mesh.faces[f][2]] - a).norm() / 2;
    }
    return sum;
}

std::vector<double> edge_lengths(const Mesh& mesh) {
    std::vector<double> lengths;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            lengths.push_back(
                (mesh.vertices_mm[mesh.faces[f][k]] - mesh.vertices_mm[mesh.faces[f][(k + 1) % 3]]).norm());
    return lengths;
}

bool has_vertex(const Mesh& mesh, const Point& p) {
    return std::any_of(mesh.vertices_mm.begin(), mesh.vertices_mm.end(), [&](const Point& v) { return v == p; });
}

/// Whether straight edges of the mesh lead from one point to the other.
bool has_line(const Mesh& mesh, const Point& from, const Point& to) {
    double covered = 0;
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    const auto on_line = [&](const Point& p) {
        return (p - from).norm() + (p - to).norm() < (to - from).norm() + 1e-9;
    };
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
            if (!on_line(mesh.vertices_mm[a]) || !on_line(mesh.vertices_mm[b])) continue;
            if (seen.insert(std::minmax(a, b)).second) covered += (mesh.vertices_mm[a] - mesh.vertices_mm[b]).norm();
        }
    return std::abs(covered - (to - from).norm()) < 1e-9;
}

TEST(Remesh, triangles_have_the_length_asked_for_and_lie_on_the_surface) {
    RemeshOptions options;
    options.edge_mm = 4;
    options.keep_lines = false;
    RemeshReport report;
    const auto mesh = patch(1, dome);
    const auto made = remesh(mesh, options, {}, &report);
    EXPECT_NEAR(report.mean_edge_mm, 4, 0.6);  // lengths end between 4/5 and 4/3 of it, more of them short
    auto lengths = edge_lengths(made);
    std::sort(lengths.begin(), lengths.end());
    EXPECT_GT(lengths[lengths.size() / 100], 4 * 0.5);
    EXPECT_LT(lengths[lengths.size() - lengths.size() / 100], 4 * 1.5);
    // Each vertex lies on a facet, none of which is longer than 2 mm: its sagitta is (2 / 2)^2 / (2 radius) at most.
    for (const auto& p : made.vertices_mm) EXPECT_NEAR(p.norm(), radius_mm, 1 / (2 * radius_mm));
}

TEST(Remesh, a_border_that_is_kept_loses_no_vertex) {
    RemeshOptions options;
    options.edge_mm = 5;
    RemeshReport report;
    const auto mesh = patch(2, dome);
    const auto made = remesh(mesh, options, {}, &report);
    EXPECT_EQ(report.protected_edges, 4U * 30);
    for (const auto& p : mesh.vertices_mm)
        EXPECT_TRUE(std::max(std::abs(p.x()), std::abs(p.y())) < 30 || has_vertex(made, p)) << p.transpose();
    EXPECT_EQ(geometry::border_edges(made.faces).size(), 4U * 30);
    EXPECT_LT(made.vertices_mm.size(), mesh.vertices_mm.size());
}

TEST(Remesh, kept_edges_that_are_too_long_are_divided_and_stay_straight) {
    RemeshOptions options;
    options.edge_mm = 2;
    const auto made = remesh(patch(30, flat), options);
    const auto border = geometry::border_edges(made.faces);
    double length_mm = 0;
    for (const auto& [a, b] : border) length_mm += (made.vertices_mm[a] - made.vertices_mm[b]).norm();
    EXPECT_NEAR(length_mm, 240, 1e-9);
    EXPECT_NEAR(area_of(made), 3600, 1e-6);
    for (const double length : edge_lengths(made)) EXPECT_LT(length, 2 * 2);
}

TEST(Remesh, a_border_that_is_resampled_keeps_its_corners_and_the_area) {
    RemeshOptions options;
    options.edge_mm = 5;
    options.keep_lines = false;
    const auto made = remesh(patch(1, flat), options);
    for (const double x : {-30, 30})
        for (const double y : {-30, 30}) EXPECT_TRUE(has_vertex(made, Point(x, y, 0))) << x << ' ' << y;
    EXPECT_NEAR(area_of(made), 3600, 1e-6);
    EXPECT_LT(geometry::border_edges(made.faces).size(), 70U);  // 240 mm in edges of 5 mm are 48; it had 240
}

TEST(Remesh, a_protected_line_is_neither_crossed_nor_moved) {
    const auto mesh = patch(2, flat);
    std::vector<geometry::Edge> line;  // slanting, where no row or column of new triangles would lie by itself
    for (std::uint32_t k = 0; k + 7 < 30; ++k) line.push_back({k * 31 + k + 7, (k + 1) * 31 + k + 8});
    const Point from(-16, -30, 0), to(30, 16, 0);
    RemeshOptions options;
    options.edge_mm = 5;
    for (const bool keep : {true, false}) {
        options.keep_lines = keep;
        EXPECT_TRUE(has_line(remesh(mesh, options, line), from, to)) << keep;
        EXPECT_FALSE(has_line(remesh(mesh, options), from, to)) << keep;
    }
}

TEST(Remesh, a_crease_is_protected_where_its_angle_is_asked_for) {
    const auto mesh = patch(2, [](double x, double) { return std::abs(x); });  // faces differ by 90 degrees
    RemeshOptions options;
    options.keep_lines = false;
    RemeshReport report;
    options.crease_deg = 80;
    EXPECT_TRUE(has_line(remesh(mesh, options, {}, &report), {0, -30, 0}, {0, 30, 0}));
    EXPECT_EQ(report.protected_edges, 4U * 30 + 30);
    options.crease_deg = 100;
    (void)remesh(mesh, options, {}, &report);
    EXPECT_EQ(report.protected_edges, 4U * 30);
}

TEST(Remesh, a_number_of_vertices_is_met_within_one_in_a_hundred) {
    RemeshOptions options;
    options.keep_lines = false;
    for (const std::size_t wanted : {300U, 1500U, 6000U}) {
        options.vertices = wanted;
        const auto made = remesh(patch(1, dome), options);
        EXPECT_NEAR(static_cast<double>(made.vertices_mm.size()), static_cast<double>(wanted), 0.01 * wanted);
    }
    options.vertices = 50;
    options.keep_lines = true;  // its border alone has 240
    EXPECT_THAT(test::message_of([&] { (void)remesh(patch(1, dome), options); }),
                HasSubstr("vertices is 50, but no edge length comes nearer"));
}

TEST(Remesh, vertices_at_one_place_are_no_border) {
    auto mesh = patch(2, flat);
    // The right half gets vertices of its own, as the seam of a texture does it.
    const auto count = static_cast<std::uint32_t>(mesh.vertices_mm.size());
    mesh.vertices_mm.insert(mesh.vertices_mm.end(), mesh.vertices_mm.begin(), mesh.vertices_mm.begin() + count);
    mesh.colours.assign(mesh.vertices_mm.size(), {1, 2, 3});
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (mesh.vertices_mm[mesh.faces[f][0]].x() >= 0)
            for (std::size_t k = mesh.faces.first[f]; k < mesh.faces.first[f + 1]; ++k) mesh.faces.corners[k] += count;
    RemeshReport report;
    EXPECT_EQ(geometry::border_edges(remesh(mesh, {}, {}, &report).faces).size(), 4U * 30);
    EXPECT_THAT(report.remarks, ::testing::ElementsAre("colours are left out: the vertices are new"));
}

TEST(Remesh, three_faces_at_an_edge_are_cut_apart_with_a_word) {
    Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {0, 20, 0}, {20, 0, 0}, {-20, 0, 0}, {0, 0, 20}};
    for (const std::uint32_t wing : {2, 3, 4}) mesh.faces.add(std::array<std::uint32_t, 3>{0, 1, wing});
    RemeshReport report;
    const auto made = remesh(mesh, {}, {}, &report);
    EXPECT_NEAR(area_of(made), 3 * 200, 1e-6);
    ASSERT_EQ(report.remarks.size(), 1U);
    EXPECT_THAT(report.remarks[0], HasSubstr("more than two faces meet"));
}

TEST(Remesh, the_same_mesh_comes_out_every_time) {
    const auto once = remesh(patch(2, dome)), again = remesh(patch(2, dome));
    EXPECT_EQ(once.vertices_mm, again.vertices_mm);
    EXPECT_EQ(once.faces.corners, again.faces.corners);
}

TEST(Remesh, what_cannot_be_is_refused_by_name) {
    const auto said = [](RemeshOptions options, std::vector<geometry::Edge> edges = {}) {
        return test::message_of([&] { (void)remesh(patch(10, flat), options, edges); });
    };
    RemeshOptions options;
    options.edge_mm = 0;
    EXPECT_THAT(said(options), HasSubstr("edge_mm is 0"));
    options.edge_mm = 1e-6;
    EXPECT_THAT(said(options), HasSubstr("million vertices"));
    options = {};
    options.iterations = 0;
    EXPECT_THAT(said(options), HasSubstr("iterations is 0"));
    EXPECT_THAT(said({}, {{0, 20}}), HasSubstr("protected edge 0-20"));
    EXPECT_THAT(said({}, {{0, 4711}}), HasSubstr("protected edge 0-4711"));
    EXPECT_THAT(test::message_of([] { (void)remesh(Mesh{{{0, 0, 0}}, {}, {}, {}, {}}); }), HasSubstr("no face"));
}

TEST(Hausdorff, sees_between_the_vertices) {
    // A tent of 3 mm over the middle of one large face: the vertices of the face lie on the tent, its middle does not.
    Mesh face, tent;
    face.vertices_mm = {{0, 0, 0}, {30, 0, 0}, {0, 30, 0}};
    face.faces.add(std::array<std::uint32_t, 3>{0, 1, 2});
    tent.vertices_mm = face.vertices_mm;
    tent.vertices_mm.emplace_back(10, 10, 3);
    tent.faces.add(std::array<std::uint32_t, 3>{0, 1, 3});
    tent.faces.add(std::array<std::uint32_t, 3>{1, 2, 3});
    tent.faces.add(std::array<std::uint32_t, 3>{2, 0, 3});
    const auto apart = hausdorff(face, tent);
    EXPECT_NEAR(apart.second_to_first_mm, 3, 0.01);  // the tip
    // The point at x = y that is as far from the two equal sides as from the third: 0.2873 y = 0.2762 (30 - 2 y).
    EXPECT_NEAR(apart.first_to_second_mm, 2.835, 0.02);
    EXPECT_EQ(apart.mm(), apart.second_to_first_mm);
}

TEST(Hausdorff, a_lifted_surface_is_as_far_as_it_was_lifted) {
    const auto lifted = [](double z) { return patch(5, [z](double, double) { return z; }); };
    const auto apart = hausdorff(lifted(0), lifted(1.25));
    EXPECT_NEAR(apart.first_to_second_mm, 1.25, 0.01);
    EXPECT_NEAR(apart.second_to_first_mm, 1.25, 0.01);
    EXPECT_NEAR(hausdorff(lifted(0), lifted(0)).mm(), 0, 0.01);
}

TEST(Hausdorff, a_remeshed_dome_lies_as_near_as_its_triangles_allow) {
    RemeshOptions options;
    options.edge_mm = 4;
    options.keep_lines = true;
    const auto mesh = patch(1, dome);
    // The sagitta of a triangle whose circumcircle has 1.33 * 4 / sqrt(3) mm: 3.1^2 / 120 = 0.08.
    EXPECT_LT(hausdorff(mesh, remesh(mesh, options)).mm(), 0.12);
}

TEST(Hausdorff, faces_without_area_do_no_harm_and_nothing_else_is_refused) {
    auto mesh = patch(10, flat);
    mesh.faces.add(std::array<std::uint32_t, 3>{0, 1, 2});  // on one line
    EXPECT_NEAR(hausdorff(mesh, patch(10, flat)).mm(), 0, 0.01);
    EXPECT_THAT(test::message_of([&] { (void)hausdorff(mesh, Mesh{}); }), HasSubstr("no face"));
    EXPECT_THAT(test::message_of([&] { (void)hausdorff(mesh, mesh, 0); }), HasSubstr("error_bound_mm is 0"));
}

}  // namespace
}  // namespace mimik::remeshing
