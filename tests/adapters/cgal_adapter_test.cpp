#include <vector>

#include <CGAL/Simple_cartesian.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/cgal.h"

namespace mimik::adapters {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;
using CgalPoint = CGAL::Simple_cartesian<double>::Point_3;

geometry::Mesh quad_and_triangle() {
    geometry::Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}, {2, 0.5, 1.0 / 3}};
    mesh.faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    mesh.faces.add(std::vector<std::uint32_t>{2, 1, 4});
    mesh.colours = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 15}};
    mesh.attributes.push_back({"distance_mm", 1, {0, 1, 2, 3, 4}});
    return mesh;
}

TEST(CgalAdapter, a_mesh_comes_back_as_it_was) {
    const auto mesh = quad_and_triangle();
    Remarks remarks;
    const auto back = from_cgal(to_cgal<CgalPoint>(mesh, remarks), remarks);
    EXPECT_EQ(back.vertices_mm, mesh.vertices_mm);
    EXPECT_EQ(back.faces.corners, mesh.faces.corners);
    EXPECT_EQ(back.faces.first, mesh.faces.first);
    EXPECT_EQ(back.colours, mesh.colours);
    ASSERT_EQ(back.attributes.size(), 1U);
    EXPECT_EQ(back.attributes[0].name, "distance_mm");
    EXPECT_EQ(back.attributes[0].values, mesh.attributes[0].values);
    EXPECT_THAT(remarks, IsEmpty());
}

TEST(CgalAdapter, what_a_surface_mesh_cannot_hold_is_said) {
    auto mesh = quad_and_triangle();
    mesh.attributes.push_back({"displacement_mm", 3, std::vector<double>(15)});
    mesh.texture_coordinates.resize(5);
    mesh.faces.add(std::vector<std::uint32_t>{0, 1});
    Remarks remarks;
    const auto surface = to_cgal<CgalPoint>(mesh, remarks);
    EXPECT_EQ(surface.number_of_faces(), 2U);
    EXPECT_THAT(remarks, ElementsAre(HasSubstr("1 face of fewer"), HasSubstr("5 texture coordinates"),
                                     HasSubstr("displacement_mm")));
}

TEST(CgalAdapter, faces_that_make_no_surface_are_refused_by_number) {
    Remarks remarks;
    auto mesh = quad_and_triangle();
    mesh.faces.add(std::vector<std::uint32_t>{0, 1, 4});  // the edge 0 -> 1 is taken
    EXPECT_THAT([&] { (void)to_cgal<CgalPoint>(mesh, remarks); },
                ThrowsMessage<InputError>(HasSubstr("face 2 cannot")));
    mesh = quad_and_triangle();
    mesh.faces.add(std::vector<std::uint32_t>{3, 4, 3});
    EXPECT_THAT([&] { (void)to_cgal<CgalPoint>(mesh, remarks); },
                ThrowsMessage<InputError>(HasSubstr("face 2 names a vertex twice")));
    mesh = quad_and_triangle();
    mesh.faces.add(std::vector<std::uint32_t>{3, 4, 5});
    EXPECT_THAT([&] { (void)to_cgal<CgalPoint>(mesh, remarks); },
                ThrowsMessage<InputError>(HasSubstr("face 2 names vertex 5, but there are only 5")));
}

TEST(CgalAdapter, what_was_removed_stays_out) {
    Remarks remarks;
    auto surface = to_cgal<CgalPoint>(quad_and_triangle(), remarks);
    CGAL::Euler::remove_face(surface.halfedge(CGAL::SM_Face_index(0)), surface);
    const auto mesh = from_cgal(surface, remarks);
    EXPECT_EQ(mesh.faces.size(), 1U);
    EXPECT_EQ(mesh.vertices_mm.size(), 3U);
    EXPECT_EQ(mesh.vertices_mm[mesh.faces[0][2]], geometry::Point(2, 0.5, 1.0 / 3));
}

}  // namespace
}  // namespace mimik::adapters
