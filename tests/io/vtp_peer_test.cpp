// .vtp between Mimik and VTK, both ways.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include "io/mesh_io.h"
#include "tests/io/files_testing.h"

namespace mimik::io {

using geometry::Mesh;
using geometry::Point;
using geometry::TextureCoordinate;
using geometry::VertexAttribute;

namespace {

Mesh wavy_quads(std::uint32_t n) {
    Mesh mesh;
    VertexAttribute displacement{"displacement_mm", 3, {}};
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t col = 0; col < n; ++col) {
            mesh.vertices_mm.emplace_back(col / 3.0, row / 7.0, std::sin(0.3 * row) * std::cos(0.2 * col));
            mesh.texture_coordinates.emplace_back(col / (n - 1.0), row / (n - 1.0));
            mesh.colours.push_back({static_cast<std::uint8_t>(row), static_cast<std::uint8_t>(col), 9});
            for (const double value : {0.1 * row, 0.1 * col, 1.0 / (1.0 + row + col)})
                displacement.values.push_back(value);
        }
    for (std::uint32_t row = 0; row + 1 < n; ++row)
        for (std::uint32_t col = 0; col + 1 < n; ++col) {
            const auto v = row * n + col;
            mesh.faces.add(std::array{v, v + 1, v + n + 1, v + n});
        }
    mesh.attributes.push_back(std::move(displacement));
    return mesh;
}

TEST(VtkReads, what_mimik_writes_to_vtp_number_for_number) {
    const TemporaryFolder folder;
    const auto mesh = wavy_quads(30);
    write_mesh(folder / "mesh.vtp", mesh);
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName((folder / "mesh.vtp").c_str());
    reader->Update();
    auto* poly = reader->GetOutput();
    ASSERT_EQ(poly->GetNumberOfPoints(), 900);
    ASSERT_EQ(poly->GetNumberOfPolys(), 29 * 29);
    auto* displacement = poly->GetPointData()->GetArray("displacement_mm");
    auto* texture = poly->GetPointData()->GetTCoords();
    auto* colours = poly->GetPointData()->GetArray("RGB");
    ASSERT_TRUE(displacement && texture && colours);
    for (vtkIdType i = 0; i < poly->GetNumberOfPoints(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        EXPECT_EQ(Point(poly->GetPoint(i)), mesh.vertices_mm[k]);
        EXPECT_EQ(Point(displacement->GetTuple(i)), Point(mesh.attributes[0].values.data() + 3 * k));
        EXPECT_EQ(TextureCoordinate(texture->GetTuple(i)), mesh.texture_coordinates[k]);
        EXPECT_EQ(colours->GetComponent(i, 1), mesh.colours[k][1]);
    }
    vtkNew<vtkIdList> cell;
    for (vtkIdType f = 0; f < poly->GetNumberOfPolys(); ++f) {
        poly->GetCellPoints(f, cell);
        const auto face = mesh.faces[static_cast<std::size_t>(f)];
        ASSERT_EQ(cell->GetNumberOfIds(), static_cast<vtkIdType>(face.size()));
        for (vtkIdType k = 0; k < cell->GetNumberOfIds(); ++k)
            EXPECT_EQ(cell->GetId(k), face[static_cast<std::size_t>(k)]);
    }
}

TEST(VtkReads, clouds_and_texture_per_corner_without_complaint) {
    const TemporaryFolder folder;
    auto mesh = wavy_quads(4);
    mesh.faces.texture_corners = mesh.faces.corners;
    std::reverse(mesh.faces.texture_corners.begin(), mesh.faces.texture_corners.end());
    Mesh cloud;
    cloud.vertices_mm = mesh.vertices_mm;
    write_mesh(folder / "corners.vtp", mesh);
    write_mesh(folder / "cloud.vtp", cloud);
    for (const auto* name : {"corners.vtp", "cloud.vtp"}) {
        vtkNew<vtkXMLPolyDataReader> reader;
        reader->SetFileName((folder / name).c_str());
        reader->Update();
        EXPECT_EQ(reader->GetErrorCode(), 0U) << name;
        EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 16) << name;
    }
}

TEST(VtkWrites, vtp_in_every_mode_that_mimik_reads) {
    const TemporaryFolder folder;
    const auto mesh = wavy_quads(60);  // several compressed blocks
    write_mesh(folder / "mesh.vtp", mesh);
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName((folder / "mesh.vtp").c_str());
    reader->Update();
    for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended})
        for (const bool zlib : {false, true})
            for (const bool encode : {false, true})
                for (const bool wide : {false, true})
                    for (const bool big : {false, true}) {
                        vtkNew<vtkXMLPolyDataWriter> writer;
                        writer->SetInputData(reader->GetOutput());
                        writer->SetFileName((folder / "vtk.vtp").c_str());
                        writer->SetDataMode(mode);
                        writer->SetEncodeAppendedData(encode);
                        if (zlib)
                            writer->SetCompressorTypeToZLib();
                        else
                            writer->SetCompressorTypeToNone();
                        writer->SetBlockSize(4096);
                        writer->SetHeaderType(wide ? vtkXMLWriter::UInt64 : vtkXMLWriter::UInt32);
                        writer->SetByteOrder(big ? vtkXMLWriter::BigEndian : vtkXMLWriter::LittleEndian);
                        ASSERT_EQ(writer->Write(), 1);
                        const auto read = read_mesh(folder / "vtk.vtp");
                        const auto what =
                            fmt::format("mode {} zlib {} base64 {} wide {} big {}", mode, zlib, encode, wide, big);
                        EXPECT_EQ(read.vertices_mm, mesh.vertices_mm) << what;
                        EXPECT_EQ(read.faces.corners, mesh.faces.corners) << what;
                        EXPECT_EQ(read.faces.first, mesh.faces.first) << what;
                        EXPECT_EQ(read.texture_coordinates, mesh.texture_coordinates) << what;
                        EXPECT_EQ(read.colours, mesh.colours) << what;
                        ASSERT_EQ(read.attributes.size(), 1U) << what;
                        EXPECT_EQ(read.attributes[0].values, mesh.attributes[0].values) << what;
                    }
}

}  // namespace
}  // namespace mimik::io
