#include "geometry/face_surface.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::geometry {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Two rows of three vertices, 1 mm apart: the middle of the lower row bridged, the last of the upper row outside.
QuadGrid small_grid() {
    QuadGrid grid;
    grid.rows = 2;
    grid.cols = 3;
    for (int row = 0; row < 2; ++row)
        for (int col = 0; col < 3; ++col) grid.vertices_mm.emplace_back(col, row, 0);
    grid.origin.assign(6, VertexOrigin::measured);
    grid.origin[1] = VertexOrigin::bridged;
    grid.origin[5] = VertexOrigin::outside;
    grid.vertices_mm[5].z() = nan;
    return grid;
}

/// A square of two triangles with the diagonal from 0 to 2, and a vertex that no face has.
Mesh small_mesh() {
    Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {nan, 0, 0}};
    mesh.faces.add(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    return mesh;
}

TEST(FaceSurface, of_a_grid_has_its_shape_and_knows_what_is_bridged_and_what_is_no_face) {
    const auto surface = face_surface(small_grid(), Landmarks({{"chin", {1, 2, 3}, ""}}));
    ASSERT_TRUE(surface.grid);
    EXPECT_EQ(surface.grid->rows, 2);
    EXPECT_EQ(surface.grid->cols, 3);
    EXPECT_THAT(surface.present, ElementsAre(1, 1, 1, 1, 1, 0));
    EXPECT_THAT(surface.measured, ElementsAre(1, 0, 1, 1, 1, 0));
    EXPECT_EQ(surface.triangles.size(), 2U);  // of the one quad whose corners are all inside
    EXPECT_EQ(surface.size(), 6U);
    EXPECT_EQ(surface.landmarks.position_mm("chin"), Point(1, 2, 3));
}

TEST(FaceSurface, of_a_mesh_is_the_vertices_of_its_faces_and_all_of_them_count_as_measured) {
    const auto surface = face_surface(small_mesh(), {});
    EXPECT_FALSE(surface.grid);
    EXPECT_THAT(surface.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    EXPECT_THAT(surface.present, ElementsAre(1, 1, 1, 1, 0));
    EXPECT_EQ(surface.measured, surface.present);
}

TEST(FaceSurface, a_mesh_without_a_face_or_with_a_corner_that_is_nowhere_is_refused) {
    auto mesh = small_mesh();
    mesh.faces.add(std::array<std::uint32_t, 3>{0, 1, 4});
    EXPECT_THAT(message_of<InputError>([&] { (void)face_surface(mesh, {}); }), HasSubstr("vertex 4"));
    mesh.faces = {};
    EXPECT_THAT(message_of<InputError>([&] { (void)face_surface(mesh, {}); }), HasSubstr("5 vertices and no face"));
}

TEST(FieldExtent, of_a_grid_compares_rows_and_columns_and_leaves_out_what_is_no_face) {
    const auto surface = face_surface(small_grid(), {});
    std::vector<Vector> field(6, Vector::Zero());
    field[5] = {100, 0, 0};  // outside
    field[1] = {0, 3, 4};
    auto extent = field_extent(surface, field);
    EXPECT_EQ(extent.largest_displacement_mm, 5);
    EXPECT_EQ(extent.largest_neighbour_step_mm, 5);
    // 3 differs from its neighbours 0 and 4; from 1, across a quad, nobody asks.
    field[4] = field[0] = field[2] = field[1];
    EXPECT_EQ(field_extent(surface, field).largest_neighbour_step_mm, 5);
    field[3] = field[1];
    extent = field_extent(surface, field);
    EXPECT_EQ(extent.largest_neighbour_step_mm, 0);
    EXPECT_EQ(extent.largest_displacement_mm, 5);
    EXPECT_EQ(field_extent(surface, field, 2 * Eigen::Matrix3d::Identity()).largest_displacement_mm, 10);
}

TEST(FieldExtent, of_a_grid_does_not_join_the_end_of_a_row_with_the_next_one) {
    auto grid = small_grid();
    grid.origin.assign(6, VertexOrigin::measured);
    const auto surface = face_surface(grid, {});
    // 1 mm more from column to column and from row to row: 2 and 3, the end of a row and the start of the next, are
    // apart.
    std::vector<Vector> field;
    for (int v = 0; v < 6; ++v) field.emplace_back(v % 3, 0, 0);
    EXPECT_EQ(field_extent(surface, field).largest_neighbour_step_mm, 1);
}

TEST(FieldExtent, of_a_mesh_goes_along_the_edges_of_its_triangles_alone) {
    const auto surface = face_surface(small_mesh(), {});
    std::vector<Vector> field(5, Vector::Zero());
    field[4] = {100, 0, 0};  // of no face
    field[1] = {1, 0, 0};
    field[3] = {-1, 0, 0};  // 1 and 3 lie 2 mm apart, and no edge joins them
    const auto extent = field_extent(surface, field);
    EXPECT_EQ(extent.largest_displacement_mm, 1);
    EXPECT_EQ(extent.largest_neighbour_step_mm, 1);
}

TEST(FieldExtent, is_infinite_where_a_number_is_none) {
    const auto surface = face_surface(small_mesh(), {});
    std::vector<Vector> field(5, Vector::Zero());
    field[2] = {nan, 0, 0};
    EXPECT_TRUE(std::isinf(field_extent(surface, field).largest_displacement_mm));
    EXPECT_TRUE(std::isinf(field_extent(surface, field).largest_neighbour_step_mm));
}

TEST(DisplacementField, that_is_still_answers_everywhere_and_moves_nothing) {
    const auto field = DisplacementField::still(5);
    EXPECT_THAT(field.answered, ElementsAre(1, 1, 1, 1, 1));
    EXPECT_EQ(moved(small_mesh(), field).vertices_mm[2], Point(1, 1, 0));
}

TEST(Moved, shifts_vertices_and_keeps_all_else_and_takes_no_field_of_another_mesh) {
    auto mesh = small_mesh();
    mesh.texture_coordinates.assign(5, {0.25, 0.5});
    auto field = DisplacementField::still(5);
    field.mm[1] = {1, 2, 3};
    const auto result = moved(mesh, field);
    EXPECT_EQ(result.vertices_mm[1], Point(2, 2, 3));
    EXPECT_EQ(result.vertices_mm[0], Point(0, 0, 0));
    EXPECT_EQ(result.faces.corners, mesh.faces.corners);
    EXPECT_EQ(result.texture_coordinates.size(), 5U);
    EXPECT_THAT(message_of<InputError>([&] { (void)moved(mesh, DisplacementField::still(4)); }),
                HasSubstr("a field of 4 vertices for a mesh of 5"));
}

}  // namespace
}  // namespace mimik::geometry
