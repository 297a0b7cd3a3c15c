#include <sstream>

#include "geometry/polygon_triangles.h"
#include "io/formats/bytes.h"
#include "io/formats/obj.h"
#include "io/formats/ply.h"
#include "io/formats/stl.h"
#include "io/formats/vtp.h"
#include "io/mesh_io.h"
#include "io/range_scan_io.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

using namespace geometry;
using namespace io;

constexpr auto format = MeshFormat::MIMIK_FUZZED;

std::string encoded(const Mesh& mesh, bool binary) {
    std::ostringstream out;
    MeshWriteOptions options;
    options.binary = binary;
    options.texture_file = "face.png";
    if (format == MeshFormat::ply) formats::encode_ply(out, mesh, options);
    if (format == MeshFormat::obj) formats::encode_obj(out, mesh, options, "face.mtl");
    if (format == MeshFormat::stl) formats::encode_stl(out, mesh, options, "seed");
    if (format == MeshFormat::vtp) formats::encode_vtp(out, mesh);
    return out.str();
}

std::string pcd(const std::string& storage) {
    std::string text =
        "VERSION 0.7\nFIELDS x y z rgb u v d\nSIZE 4 4 4 4 4 4 8\nTYPE F F F U F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH "
        "2\nHEIGHT 2\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA " +
        storage + "\n";
    if (storage == "ascii") return text + "0 0 0 1 0 0 1\n1 0 nan 2 0 0 1\n0 1 0 3 0 0 1\n1 1 0 4 0 0 1\n";
    const std::string points(4 * 32, '\1');
    if (storage == "binary") return text + points;
    std::string packed;  // LZF: runs of up to 32 literal bytes
    for (std::size_t at = 0; at < points.size(); at += 32) packed += '\x1F' + points.substr(at, 32);
    formats::append(text, static_cast<std::uint32_t>(packed.size()));
    formats::append(text, static_cast<std::uint32_t>(points.size()));
    return text + packed;
}

void check_sound(const Mesh& mesh) {
    const auto n = mesh.vertices_mm.size();
    require(n > 0, "a mesh that was read has vertices");
    require(mesh.faces.first.front() == 0 && mesh.faces.first.back() == mesh.faces.corners.size(),
            "faces cover the corners");
    for (const auto corner : mesh.faces.corners) require(corner < n, "corners are vertices");
    require(mesh.colours.empty() || mesh.colours.size() == n, "one colour per vertex");
    if (mesh.faces.texture_corners.empty())
        require(mesh.texture_coordinates.empty() || mesh.texture_coordinates.size() == n,
                "one texture position per vertex");
    else
        require(mesh.faces.texture_corners.size() == mesh.faces.corners.size(), "one texture corner per corner");
    for (const auto corner : mesh.faces.texture_corners)
        require(corner < mesh.texture_coordinates.size(), "texture corners are texture positions");
    for (const auto& attribute : mesh.attributes)
        require(
            attribute.components > 0 && attribute.values.size() == n * static_cast<std::size_t>(attribute.components),
            "attributes cover the vertices");
    for (const auto& p : mesh.vertices_mm) require(format == MeshFormat::pcd || p.allFinite(), "positions are finite");
    const auto triangles = triangulate(mesh.faces, mesh.vertices_mm);
    require(triangles.size() + 2 * mesh.faces.size() == mesh.faces.corners.size(), "n corners give n - 2 triangles");
}

}  // namespace

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto file = decode_mesh(format, bytes, "input", LengthUnit::centimetre);
    check_sound(file.mesh);
    if (format != MeshFormat::pcd && format != MeshFormat::stl) {
        const auto text = encoded(file.mesh, true);
        const auto again =
            decode_mesh(format, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "again");
        require(again.mesh.vertices_mm == file.mesh.vertices_mm, "what was written reads back");
        require(again.mesh.faces.corners == file.mesh.faces.corners, "faces read back");
    }
    (void)to_range_scan(file, "input");
}

std::vector<std::string> seeds() {
    if (format == MeshFormat::pcd) return {pcd("ascii"), pcd("binary"), pcd("binary_compressed")};
    Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {10, 10, 1}, {0, 10, 2}, {5, 5, 5}};
    mesh.faces.add(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    mesh.faces.add(std::array<std::uint32_t, 3>{2, 3, 4});
    std::vector<std::string> files = {encoded(mesh, true), encoded(mesh, false)};
    mesh.colours.assign(5, {1, 2, 3});
    mesh.attributes.push_back({"displacement_mm", 3, std::vector<double>(15, 0.5)});
    mesh.texture_coordinates.assign(5, {0.25, 0.75});
    files.push_back(encoded(mesh, true));
    files.push_back(encoded(mesh, false));
    mesh.faces.texture_corners = {0, 1, 2, 3, 4, 4, 4};
    files.push_back(encoded(mesh, true));
    if (format == MeshFormat::ply)
        files.emplace_back(
            "ply\rformat ascii 1.0\rcomment SPACE=RAS\relement vertex 4\rproperty float x\rproperty float y\rproperty "
            "float "
            "z\rproperty ushort red\rproperty ushort green\rproperty ushort blue\relement tristrips 1\rproperty list "
            "int int "
            "vertex_indices\rend_header\r0 0 0 1 2 3\r1 0 0 4 5 6\r0 1 0 7 8 9\r1 1 0 1 2 65535\r6 0 1 2 3 -1 0\r");
    if (format == MeshFormat::stl)
        files.emplace_back(
            "solid a facet normal 1.#QNAN 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 end loop endfacet "
            "endsolid a "
            "solid b # SPACE=LPS\nFACET\nOUTER LOOP\n");
    if (format == MeshFormat::ply)
        files.emplace_back("ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\nend_header\n");
    if (format == MeshFormat::vtp)
        files.emplace_back(
            "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece "
            "NumberOfPoints=\"3\"><Points>"
            "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 "
            "0</DataArray></Points>"
            "<PointData><DataArray type=\"UInt8\" Name=\"d\" "
            "format=\"binary\">AQAAAAMAAAAAAAAACwAAAA==eJxjZGIGAAANAAc=</DataArray>"
            "</PointData><Strips><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>"
            "<DataArray type=\"Int32\" Name=\"offsets\" "
            "format=\"ascii\">3</DataArray></Strips></Piece></PolyData></VTKFile>");
    if (format == MeshFormat::vtp) {  // two arrays of the same data
        std::string shared =
            "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\"><Points><DataArray type=\"Float32\" "
            "NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points><PointData><DataArray "
            "type=\"UInt8\" Name=\"a\" NumberOfComponents=\"12\" format=\"appended\" offset=\"0\"/></PointData>"
            "</Piece></PolyData><AppendedData encoding=\"raw\">_";
        formats::append(shared, std::uint32_t{12});
        for (const float value : {1.F, 2.F, 3.F}) formats::append(shared, value);
        files.push_back(shared + "</AppendedData></VTKFile>");
    }
    return files;
}

}  // namespace mimik::fuzzing
