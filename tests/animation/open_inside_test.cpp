#include "animation/open_inside.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::animation {
namespace {

using geometry::Mesh;
using geometry::Point;

/// Three columns of one quad each, 2 mm wide and high, seen from the front; sheets 1 above and 2 below.
Mesh strip() {
    Mesh mesh;
    for (const double y : {0.0, 2.0})
        for (int k = 0; k < 4; ++k) {
            mesh.vertices_mm.emplace_back(2.0 * k, y, 10.0);
            mesh.texture_coordinates.emplace_back(k / 4.0, y);
        }
    for (std::uint32_t k = 0; k < 3; ++k) mesh.faces.add(std::array<std::uint32_t, 4>{k, k + 1, k + 5, k + 4});
    mesh.attributes.push_back({"origin", 1, {0, 1, 2, 3, 4, 5, 6, 7}});
    return mesh;
}
const std::vector<std::uint32_t> sheets = {2, 2, 2, 2, 1, 1, 1, 1};

double area_mm2(const Mesh& mesh, std::size_t first_face, std::size_t end_face, std::span<const Point> vertices_mm) {
    double sum = 0;
    for (std::size_t f = first_face; f < end_face; ++f) {
        const auto face = mesh.faces[f];
        for (std::size_t k = 1; k + 1 < face.size(); ++k)
            sum += 0.5 * (vertices_mm[face[k]] - vertices_mm[face[0]])
                             .cross(vertices_mm[face[k + 1]] - vertices_mm[face[0]])
                             .z();
    }
    return sum;
}

TEST(OpenInside, covers_at_rest_what_the_surface_covered_and_nothing_of_the_dark_is_seen) {
    const auto opened = open_between_sheets(strip(), std::vector<std::uint8_t>{1, 1, 0}, sheets);
    // Two quads in halves, one whole, two dark ones. Halves turn as the quads did: no area is negative.
    ASSERT_EQ(opened.mesh.faces.size(), 7U);
    EXPECT_DOUBLE_EQ(area_mm2(opened.mesh, 0, 5, opened.mesh.vertices_mm), 12);
    EXPECT_DOUBLE_EQ(area_mm2(opened.mesh, 5, 7, opened.mesh.vertices_mm), 0);
    EXPECT_EQ(opened.skin_vertices, 8U + 6U);
    EXPECT_EQ(opened.mesh.vertices_mm.size(), 8U + 6U + 6U);
    for (std::size_t v = 0; v < opened.mesh.vertices_mm.size(); ++v)
        EXPECT_DOUBLE_EQ(opened.mesh.vertices_mm[v].z(), v < opened.skin_vertices ? 10 : 9);
}

TEST(OpenInside, the_dark_is_as_large_as_the_way_that_the_sheets_part) {
    const auto opened = open_between_sheets(strip(), std::vector<std::uint8_t>{1, 1, 0}, sheets);
    auto moved = opened.mesh.vertices_mm;
    for (std::size_t v = 0; v < moved.size(); ++v)
        if (sheets[opened.moves_with[v]] == 1) moved[v].y() += 5;
    EXPECT_DOUBLE_EQ(area_mm2(opened.mesh, 5, 7, moved), 4 * 5.0);
    // The third quad is one web: it is drawn out from 2 mm to 7.
    EXPECT_DOUBLE_EQ(area_mm2(opened.mesh, 0, 5, moved), 8 + 2 * 7.0);
}

TEST(OpenInside, new_vertices_lie_half_way_with_the_texture_of_their_place_and_the_values_of_their_sheet) {
    const auto opened = open_between_sheets(strip(), std::vector<std::uint8_t>{1, 0, 0}, sheets);
    for (std::size_t v = 8; v < opened.mesh.vertices_mm.size(); ++v) {
        EXPECT_DOUBLE_EQ(opened.mesh.vertices_mm[v].y(), 1);
        EXPECT_DOUBLE_EQ(opened.mesh.texture_coordinates[v].y(), 1);
        EXPECT_EQ(opened.mesh.attributes[0].values[v], opened.moves_with[v]);
    }
    ASSERT_EQ(opened.mesh.attributes[0].values.size(), opened.mesh.vertices_mm.size());
}

TEST(OpenInside, a_face_of_three_sheets_is_cut_into_three_around_one_dark_face) {
    Mesh triangle;
    triangle.vertices_mm = {{0, 0, 0}, {6, 0, 0}, {0, 6, 0}};
    triangle.faces.add(std::array<std::uint32_t, 3>{0, 1, 2});
    const auto opened =
        open_between_sheets(triangle, std::vector<std::uint8_t>{1}, std::vector<std::uint32_t>{0, 1, 2});
    ASSERT_EQ(opened.mesh.faces.size(), 4U);
    EXPECT_EQ(opened.mesh.faces[3].size(), 6U);
    // What the three corners do not cover, the dark does: the triangle has no hole.
    EXPECT_DOUBLE_EQ(area_mm2(opened.mesh, 0, 4, opened.mesh.vertices_mm), 18);
}

TEST(OpenInside, lines_have_a_dark_strip_between_them) {
    const Mesh mesh = strip();
    auto opened = open_between_lines(mesh, std::vector<std::uint32_t>{4, 5, 6}, std::vector<std::uint32_t>{0, 1, 2});
    EXPECT_DOUBLE_EQ(area_mm2(opened.mesh, 3, 5, opened.mesh.vertices_mm), 8);
    colour_inside(opened, {9, 9, 9});
    ASSERT_EQ(opened.mesh.colours.size(), 14U);
    EXPECT_EQ(opened.mesh.colours[7], (std::array<std::uint8_t, 3>{9, 9, 9}));
    EXPECT_EQ(opened.mesh.colours[8], inside_colour);
    EXPECT_THROW((void)open_between_lines(mesh, sheets, {}), InputError);
}

TEST(OpenInside, a_strip_ends_in_a_triangle_where_the_lines_meet) {
    const auto opened =
        open_between_lines(strip(), std::vector<std::uint32_t>{4, 5, 2}, std::vector<std::uint32_t>{4, 1, 2});
    EXPECT_EQ(opened.mesh.faces[3].size(), 3U);
    EXPECT_EQ(opened.mesh.faces[4].size(), 3U);
}

TEST(OpenInside, a_surface_that_nothing_tears_is_as_it_was) {
    const auto opened = open_between_sheets(strip(), std::vector<std::uint8_t>{0, 0, 0}, sheets);
    EXPECT_EQ(opened.mesh.faces.corners, strip().faces.corners);
    EXPECT_EQ(opened.skin_vertices, 8U);
}

}  // namespace
}  // namespace mimik::animation
