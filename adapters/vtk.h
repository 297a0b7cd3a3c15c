#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include "adapters/remarks.h"
#include "base/text.h"
#include "geometry/mesh.h"

namespace mimik::adapters {

/// VTK's surface of Mimik's mesh, in the same millimetres and axes, in double precision. Faces keep their corners,
/// attributes become point arrays of their names, colours the scalars "RGB". Texture coordinates of one per vertex
/// become those of VTK; where corners of one vertex differ they are left out with a remark, as are faces of fewer than
/// three corners.
/// @throws InputError if a face names a vertex that is not there.
[[nodiscard]] inline vtkSmartPointer<vtkPolyData> to_vtk(const geometry::Mesh& mesh, Remarks& remarks) {
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices_mm.size()));
    for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v)
        points->SetPoint(static_cast<vtkIdType>(v), mesh.vertices_mm[v].data());
    surface->SetPoints(points);
    auto faces = vtkSmartPointer<vtkCellArray>::New();
    std::size_t small = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto face = mesh.faces[f];
        if (face.size() < 3) {
            ++small;
            continue;
        }
        faces->InsertNextCell(static_cast<int>(face.size()));
        for (const auto v : face) {
            check_index(v, mesh.vertices_mm.size(), f, "vtkPolyData");
            faces->InsertCellPoint(v);
        }
    }
    surface->SetPolys(faces);
    remark_small_faces(small, remarks);
    if (!mesh.faces.texture_corners.empty())
        remark_texture(mesh, "vtkPolyData has one per vertex and", remarks);
    else if (!mesh.texture_coordinates.empty()) {
        auto texture = vtkSmartPointer<vtkFloatArray>::New();
        texture->SetName("TCoords");
        texture->SetNumberOfComponents(2);
        for (const auto& t : mesh.texture_coordinates) texture->InsertNextTuple2(t.x(), t.y());
        surface->GetPointData()->SetTCoords(texture);
    }
    if (!mesh.colours.empty()) {
        auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
        colours->SetName("RGB");
        colours->SetNumberOfComponents(3);
        for (const auto& c : mesh.colours) colours->InsertNextTuple3(c[0], c[1], c[2]);
        surface->GetPointData()->SetScalars(colours);
    }
    for (const auto& attribute : mesh.attributes) {
        auto values = vtkSmartPointer<vtkDoubleArray>::New();
        values->SetName(attribute.name.c_str());
        values->SetNumberOfComponents(attribute.components);
        values->SetNumberOfTuples(static_cast<vtkIdType>(mesh.vertices_mm.size()));
        for (std::size_t k = 0; k < attribute.values.size(); ++k)
            values->SetValue(static_cast<vtkIdType>(k), attribute.values[k]);
        surface->GetPointData()->AddArray(values);
    }
    return surface;
}

namespace vtk_detail {

/// VTK's own name for what a mesh of Mimik's keeps in other places.
inline bool is_colour(vtkDataArray* array) {
    return array->GetDataType() == VTK_UNSIGNED_CHAR && array->GetNumberOfComponents() == 3;
}

inline void add_polygons(vtkPolyData& surface, geometry::Mesh& mesh, Remarks& remarks) {
    std::size_t small = 0, face = 0;
    std::vector<std::uint32_t> corners;
    auto cells = vtk::TakeSmartPointer(surface.GetPolys()->NewIterator());
    for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell(), ++face) {
        vtkIdType count = 0;
        const vtkIdType* ids = nullptr;
        cells->GetCurrentCell(count, ids);
        corners.clear();
        for (vtkIdType k = 0; k < count; ++k) {
            check_index(static_cast<std::uint64_t>(ids[k]), mesh.vertices_mm.size(), face, "vtkPolyData");
            corners.push_back(static_cast<std::uint32_t>(ids[k]));
        }
        if (corners.size() < 3)
            ++small;
        else
            mesh.faces.add(corners);
    }
    remark_small_faces(small, remarks);
}

/// Every second triangle of a strip runs the other way round.
inline void add_strips(vtkPolyData& surface, geometry::Mesh& mesh) {
    std::size_t strip = 0;
    auto cells = vtk::TakeSmartPointer(surface.GetStrips()->NewIterator());
    for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell(), ++strip) {
        vtkIdType count = 0;
        const vtkIdType* ids = nullptr;
        cells->GetCurrentCell(count, ids);
        for (vtkIdType k = 0; k < count; ++k)
            check_index(static_cast<std::uint64_t>(ids[k]), mesh.vertices_mm.size(), strip, "vtkPolyData, strips");
        for (vtkIdType k = 0; k + 2 < count; ++k) {
            const auto at = [&](vtkIdType i) { return static_cast<std::uint32_t>(ids[k + i]); };
            mesh.faces.add(k % 2 == 0 ? std::array{at(0), at(1), at(2)} : std::array{at(1), at(0), at(2)});
        }
    }
}

inline void add_arrays(vtkPolyData& surface, geometry::Mesh& mesh, Remarks& remarks) {
    vtkPointData& data = *surface.GetPointData();
    if (auto* texture = data.GetTCoords(); texture != nullptr) {
        if (texture->GetNumberOfComponents() == 2)
            for (vtkIdType v = 0; v < texture->GetNumberOfTuples(); ++v)
                mesh.texture_coordinates.emplace_back(texture->GetComponent(v, 0), texture->GetComponent(v, 1));
        else
            remarks.push_back("texture coordinates of " + std::to_string(texture->GetNumberOfComponents()) +
                              " components are left out");
    }
    for (int k = 0; k < data.GetNumberOfArrays(); ++k) {
        auto* array = data.GetArray(k);  // null for text
        const std::string name = data.GetArrayName(k) != nullptr ? data.GetArrayName(k) : "";
        if (array != nullptr && array == data.GetTCoords()) continue;
        if (array == nullptr || name.empty()) {
            remarks.push_back("point array \"" + name + "\" is left out: it has no " +
                              (name.empty() ? "name" : "numbers"));
            continue;
        }
        if (mesh.colours.empty() && is_colour(array)) {
            for (vtkIdType v = 0; v < array->GetNumberOfTuples(); ++v) {
                std::array<std::uint8_t, 3> colour{};
                for (int c = 0; c < 3; ++c)
                    colour[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(array->GetComponent(v, c));
                mesh.colours.push_back(colour);
            }
            continue;
        }
        geometry::VertexAttribute attribute{name, array->GetNumberOfComponents(), {}};
        for (vtkIdType v = 0; v < array->GetNumberOfTuples(); ++v)
            for (int c = 0; c < attribute.components; ++c) attribute.values.push_back(array->GetComponent(v, c));
        mesh.attributes.push_back(std::move(attribute));
    }
}

}  // namespace vtk_detail

/// Mimik's mesh of VTK's surface: polygons as they are, strips as triangles, the first point array of three bytes as
/// colours, other point arrays (normals, too) as attributes of their names. Lone vertices' cells, lines, arrays of
/// cells and text are left out with a remark.
/// @throws InputError if a cell names a point that is not there, or there are more points than 32 bits count.
[[nodiscard]] inline geometry::Mesh from_vtk(vtkPolyData& surface, Remarks& remarks) {
    geometry::Mesh mesh;
    const auto count = static_cast<std::size_t>(surface.GetNumberOfPoints());
    check_count(count, std::numeric_limits<std::uint32_t>::max(), "vtkPolyData");
    for (std::size_t v = 0; v < count; ++v) {
        std::array<double, 3> p{};
        surface.GetPoint(static_cast<vtkIdType>(v), p.data());
        mesh.vertices_mm.emplace_back(p[0], p[1], p[2]);
    }
    vtk_detail::add_polygons(surface, mesh, remarks);
    vtk_detail::add_strips(surface, mesh);
    vtk_detail::add_arrays(surface, mesh, remarks);
    const auto left_out = [&](vtkIdType cells, const char* one, const char* many) {
        if (cells > 0) remarks.push_back(base::counted(cells, one, many) + " left out");
    };
    left_out(surface.GetNumberOfVerts(), "cell that is a point is", "cells that are points are");
    left_out(surface.GetNumberOfLines(), "cell that is a line is", "cells that are lines are");
    left_out(surface.GetCellData()->GetNumberOfArrays(), "array of cells is", "arrays of cells are");
    return mesh;
}

}  // namespace mimik::adapters
