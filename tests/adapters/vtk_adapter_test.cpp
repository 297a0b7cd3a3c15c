#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/vtk.h"

namespace mimik::adapters {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

geometry::Mesh quad_and_triangle() {
    geometry::Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}, {2, 0.5, 1.0 / 3}};
    mesh.faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    mesh.faces.add(std::vector<std::uint32_t>{2, 1, 4});
    return mesh;
}

TEST(VtkAdapter, a_mesh_comes_back_as_it_was) {
    auto mesh = quad_and_triangle();
    mesh.colours = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 255}};
    mesh.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.25}};
    mesh.attributes.push_back({"displacement_mm", 3, std::vector<double>(15, 0.1)});
    Remarks remarks;
    const auto back = from_vtk(*to_vtk(mesh, remarks), remarks);
    EXPECT_EQ(back.vertices_mm, mesh.vertices_mm);
    EXPECT_EQ(back.faces.corners, mesh.faces.corners);
    EXPECT_EQ(back.faces.first, mesh.faces.first);
    EXPECT_EQ(back.colours, mesh.colours);
    EXPECT_EQ(back.texture_coordinates, mesh.texture_coordinates);
    ASSERT_EQ(back.attributes.size(), 1U);
    EXPECT_EQ(back.attributes[0].name, "displacement_mm");
    EXPECT_EQ(back.attributes[0].components, 3);
    EXPECT_EQ(back.attributes[0].values, mesh.attributes[0].values);
    EXPECT_THAT(remarks, IsEmpty());
}

TEST(VtkAdapter, strips_become_triangles_that_face_one_way) {
    Remarks remarks;
    auto surface = to_vtk(quad_and_triangle(), remarks);
    auto strips = vtkSmartPointer<vtkCellArray>::New();
    strips->InsertNextCell({0, 1, 3, 2});
    surface->SetPolys(vtkSmartPointer<vtkCellArray>::New());
    surface->SetStrips(strips);
    EXPECT_THAT(from_vtk(*surface, remarks).faces.corners, ElementsAre(0, 1, 3, 3, 1, 2));
}

TEST(VtkAdapter, what_mimik_does_not_keep_is_said) {
    auto mesh = quad_and_triangle();
    mesh.faces.add(std::vector<std::uint32_t>{0, 1});
    mesh.texture_coordinates.resize(7);
    mesh.faces.texture_corners.assign(mesh.faces.corners.size(), 6);
    Remarks remarks;
    auto surface = to_vtk(mesh, remarks);
    EXPECT_THAT(remarks, ElementsAre(HasSubstr("1 face of fewer"), HasSubstr("7 texture coordinates")));
    remarks.clear();
    auto lines = vtkSmartPointer<vtkCellArray>::New();
    lines->InsertNextCell({0, 1, 2});
    surface->SetLines(lines);
    auto dots = vtkSmartPointer<vtkCellArray>::New();
    dots->InsertNextCell({4});
    surface->SetVerts(dots);
    auto of_cells = vtkSmartPointer<vtkDoubleArray>::New();
    of_cells->SetName("area");
    surface->GetCellData()->AddArray(of_cells);
    EXPECT_EQ(from_vtk(*surface, remarks).faces.size(), 2U);
    EXPECT_THAT(remarks,
                ElementsAre(HasSubstr("1 cell that is a point is left out"),
                            HasSubstr("1 cell that is a line is left out"), HasSubstr("1 array of cells is left out")));
}

TEST(VtkAdapter, a_cell_that_names_no_point_is_refused) {
    Remarks remarks;
    auto surface = to_vtk(quad_and_triangle(), remarks);
    surface->GetPolys()->InsertNextCell({0, 1, 5});
    EXPECT_THAT([&] { (void)from_vtk(*surface, remarks); },
                ThrowsMessage<InputError>(HasSubstr("face 2 names vertex 5, but there are only 5")));
    auto mesh = quad_and_triangle();
    mesh.faces.add(std::vector<std::uint32_t>{0, 1, 9});
    EXPECT_THAT([&] { (void)to_vtk(mesh, remarks); }, ThrowsMessage<InputError>(HasSubstr("face 2 names vertex 9")));
}

}  // namespace
}  // namespace mimik::adapters
