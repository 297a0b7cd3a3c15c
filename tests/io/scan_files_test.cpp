#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <liblzf/lzf.h>
#include <zlib.h>

#include "base/file.h"
#include "io/formats/bytes.h"
#include "io/range_scan_io.h"
#include "tests/io/files_testing.h"

namespace mimik::io {

using geometry::Mesh;
using geometry::Point;
using geometry::TextureCoordinate;

namespace {

using formats::append;
using testing::ElementsAre;
using testing::HasSubstr;

MeshFile decode(MeshFormat format, const std::string& text) { return decode_mesh(format, bytes_of(text), "scan"); }

std::string refused(MeshFormat format, const std::string& text) {
    return message_of([&] { (void)decode(format, text); });
}

/// A tetrahedron whose coordinates a float holds exactly.
Mesh tetrahedron() {
    Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {10.5, 0, 0}, {0, 20.25, 0}, {0, 0, -30.125}};
    for (const auto& face : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
        mesh.faces.add(face);
    return mesh;
}

// ---- STL

TEST(Stl, corners_at_one_position_become_one_vertex) {
    const TemporaryFolder folder;
    const auto mesh = tetrahedron();
    for (const bool binary : {true, false}) {
        MeshWriteOptions options;
        options.binary = binary;
        write_mesh(folder / "mesh.stl", mesh, options);
        const auto read = read_mesh(folder / "mesh.stl");
        // Vertices come in the order in which the faces meet them, which is the order of this mesh.
        EXPECT_EQ(read.vertices_mm, mesh.vertices_mm) << binary;
        EXPECT_EQ(read.faces.corners, mesh.faces.corners) << binary;
        EXPECT_EQ(read.faces.first, mesh.faces.first) << binary;
    }
}

TEST(Stl, a_binary_file_that_begins_with_solid_is_known_by_its_size) {
    std::string text = "solid but binary";
    text.resize(80, ' ');
    append(text, std::uint32_t{1});
    for (const float value : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, -0.F, 1.F, 0.F}) append(text, value);
    append(text, std::uint16_t{7});
    EXPECT_EQ(decode(MeshFormat::stl, text).mesh.vertices_mm.size(), 3U);
    text[0] = 'X';
    EXPECT_THAT(decode(MeshFormat::stl, text + "xyz").remarks,
                ElementsAre("scan: 3 bytes behind the last triangle are passed over"));
    EXPECT_THAT(refused(MeshFormat::stl, text.substr(0, 133)),
                HasSubstr("scan: has 133 bytes, but the 1 triangle of its header (byte 80) need 134"));
    text[80] = text[81] = text[82] = text[83] = '\xFF';
    EXPECT_THAT(refused(MeshFormat::stl, text),
                HasSubstr("the 4294967295 triangles of its header (byte 80) need 214748364834"));
}

TEST(Stl, errors_name_line_and_value) {
    const std::string head = "solid x\nfacet normal 0 0 1\nouter loop\n";
    EXPECT_THAT(refused(MeshFormat::stl, "hello"), HasSubstr("scan: has 5 bytes and does not start with 'solid'"));
    EXPECT_THAT(refused(MeshFormat::stl, head + "vertex 0 0 up\n"),
                HasSubstr("scan: line 4: z is 'up', not a finite number"));
    EXPECT_THAT(refused(MeshFormat::stl, head + "vertex 0 0 nan\n"), HasSubstr("scan: line 4: z is 'nan'"));
    EXPECT_THAT(refused(MeshFormat::stl, head + "vertex 0 0 0\nendloop\n"),
                HasSubstr("scan: line 5: a facet has 1 vertex"));
    EXPECT_THAT(refused(MeshFormat::stl, head + "vertex 0 0 0\n"), HasSubstr("the last facet has no 'endloop'"));
    EXPECT_THAT(refused(MeshFormat::stl, head + "vertex 0 0 0\nouter loop\n"),
                HasSubstr("scan: line 5: an 'outer loop' stands inside another"));
    EXPECT_THAT(refused(MeshFormat::stl, "solid x\nvertex 0 0 0\n"),
                HasSubstr("scan: line 2: a vertex stands outside"));
    EXPECT_THAT(refused(MeshFormat::stl, "solid x\ncorner 0 0 0\n"),
                HasSubstr("scan: line 2: 'corner' is no STL keyword"));
    EXPECT_THAT(refused(MeshFormat::stl, "solid x\nendsolid x\n"), HasSubstr("there is no vertex in it"));
    const TemporaryFolder folder;
    auto mesh = tetrahedron();
    mesh.faces = {};
    EXPECT_THAT(message_of([&] { write_mesh(folder / "a.stl", mesh); }), HasSubstr("STL holds triangles only"));
    mesh = tetrahedron();
    mesh.vertices_mm[0].x() = 1e39;
    EXPECT_THAT(message_of([&] { write_mesh(folder / "a.stl", mesh); }),
                HasSubstr("coordinate 1e+39 is too large for STL"));
}

// ---- PCD

const std::string pcd_head =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

TEST(Pcd, ascii_points_colours_and_further_fields_are_read) {
    const auto mesh =
        decode(MeshFormat::pcd,
               "VERSION 0.7\nFIELDS y x z rgb normal_x curvature feature u v _\nSIZE 4 4 8 4 4 4 2 4 4 1\n"
               "TYPE F F F U F F I F F U\nCOUNT 1 1 1 1 1 1 2 1 1 3\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
               "POINTS 2\nDATA ascii\n2 1 3 66051 9 0.5 7 8 0.25 0.75 0 0 0\n5 4 6 4278255360 9 1.5 -7 -8 0 1 0 0 0\n")
            .mesh;
    EXPECT_THAT(mesh.vertices_mm, ElementsAre(Point(1, 2, 3), Point(4, 5, 6)));
    EXPECT_THAT(mesh.colours,
                ElementsAre(std::array<std::uint8_t, 3>{1, 2, 3}, std::array<std::uint8_t, 3>{0, 255, 0}));
    EXPECT_THAT(mesh.texture_coordinates, ElementsAre(TextureCoordinate(0.25, 0.75), TextureCoordinate(0, 1)));
    ASSERT_EQ(mesh.attributes.size(), 2U);
    EXPECT_EQ(mesh.attributes[0].name, "curvature");
    EXPECT_THAT(mesh.attributes[0].values, ElementsAre(0.5, 1.5));
    EXPECT_EQ(mesh.attributes[1].name, "feature");
    EXPECT_EQ(mesh.attributes[1].components, 2);
    EXPECT_THAT(mesh.attributes[1].values, ElementsAre(7, 8, -7, -8));
}

/// 2 rows from the top, 3 columns, one point not measured.
std::string lattice(const std::string& storage) {
    std::string text = pcd_head + "WIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6\nDATA " + storage + "\n";
    const float nan = std::nanf("");
    const std::array<std::array<float, 3>, 6> points = {
        {{0, 1, 5}, {1, 1, 6}, {2, 1, 7}, {0, 0, 8}, {nan, nan, nan}, {2, 0, 9}}};
    std::string together, apart;
    for (const auto& p : points) {
        for (const float value : p) append(together, value);
        if (storage == "ascii") text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const auto& p : points) append(apart, p[axis]);
    if (storage == "binary") text += together;
    if (storage == "binary_compressed") {
        // LZF without any repetition: runs of at most 32 literal bytes, each after its length less one.
        std::string packed;
        for (std::size_t at = 0; at < apart.size(); at += 32) {
            const auto run = apart.substr(at, 32);
            packed += static_cast<char>(run.size() - 1);
            packed += run;
        }
        append(text, static_cast<std::uint32_t>(packed.size()));
        append(text, static_cast<std::uint32_t>(apart.size()));
        text += packed;
    }
    return text;
}

TEST(Pcd, a_lattice_comes_the_right_way_up_with_its_gaps_in_every_storage) {
    const TemporaryFolder folder;
    for (const auto* storage : {"ascii", "binary", "binary_compressed"}) {
        base::write_atomically(folder / "scan.pcd", lattice(storage));
        const auto scan = read_range_scan(folder / "scan.pcd");
        ASSERT_EQ(scan.rows, 2) << storage;
        ASSERT_EQ(scan.cols, 3) << storage;
        EXPECT_EQ(scan.points_mm[0], Point(0, 0, 8)) << storage;
        EXPECT_FALSE(scan.valid(1)) << storage;
        EXPECT_EQ(scan.points_mm[2], Point(2, 0, 9)) << storage;
        EXPECT_EQ(scan.points_mm[3], Point(0, 1, 5)) << storage;
        EXPECT_EQ(scan.points_mm[5], Point(2, 1, 7)) << storage;
        // As a mesh, only what was measured is there.
        EXPECT_EQ(read_mesh(folder / "scan.pcd").vertices_mm.size(), 5U) << storage;
    }
}

TEST(Pcd, compressed_repetitions_are_unpacked) {
    std::string apart;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 1000; ++i) append(apart, static_cast<float>(axis + i / 100));
    std::string packed(apart.size(), 0);
    packed.resize(lzf_compress(apart.data(), static_cast<unsigned>(apart.size()), packed.data(),
                               static_cast<unsigned>(packed.size())));
    ASSERT_LT(packed.size(), apart.size() / 10);
    std::string text = pcd_head + "WIDTH 1000\nHEIGHT 1\nDATA binary_compressed\n";
    append(text, static_cast<std::uint32_t>(packed.size()));
    append(text, static_cast<std::uint32_t>(apart.size()));
    const auto points = decode(MeshFormat::pcd, text + packed).mesh.vertices_mm;
    ASSERT_EQ(points.size(), 1000U);
    for (int i = 0; i < 1000; ++i)
        EXPECT_EQ(points[static_cast<std::size_t>(i)], Point(i / 100, 1 + i / 100, 2 + i / 100));
}

TEST(Pcd, columns_that_run_against_x_are_turned) {
    const auto file = decode(MeshFormat::pcd, pcd_head + "WIDTH 2\nHEIGHT 2\nDATA ascii\n9 0 1\n8 0 2\n9 5 3\n8 5 4\n");
    const auto scan = to_range_scan(file, "scan");
    EXPECT_THAT(scan.points_mm, ElementsAre(Point(8, 0, 2), Point(9, 0, 1), Point(8, 5, 4), Point(9, 5, 3)));
}

TEST(Pcd, errors_name_the_line_the_field_and_the_value) {
    const auto with = [](const std::string& rest) { return refused(MeshFormat::pcd, pcd_head + rest); };
    EXPECT_THAT(refused(MeshFormat::pcd, "ply\n"), HasSubstr("scan: line 1: 'ply' is no PCD header keyword"));
    EXPECT_THAT(with("WIDTH 2\n"), HasSubstr("the header has no DATA line"));
    EXPECT_THAT(with("WIDTH -1\n"), HasSubstr("scan: line 7: WIDTH is '-1'"));
    EXPECT_THAT(with("SIZE 4 4\n"), HasSubstr("scan: line 7: SIZE has 2 entries for 3 fields"));
    EXPECT_THAT(with("SIZE 4 4 3\n"), HasSubstr("SIZE of field 'z' is 3"));
    EXPECT_THAT(with("SIZE 4 4 2\nDATA ascii\n"), HasSubstr("field 'z' is a real number of 2 bytes"));
    EXPECT_THAT(with("TYPE F F X\n"), HasSubstr("TYPE of field 'z' is 'X'"));
    EXPECT_THAT(with("COUNT 1 1 1000000\n"),
                HasSubstr("COUNT is '1000000'; it must be a whole number from 1 to 10000"));
    EXPECT_THAT(with("DATA zip\n"), HasSubstr("DATA is 'zip'"));
    EXPECT_THAT(with("WIDTH 2\nPOINTS 3\nDATA ascii\n"), HasSubstr("POINTS is 3, but WIDTH x HEIGHT is 2 x 1"));
    EXPECT_THAT(with("WIDTH 1\nDATA ascii\n1 2 b\n"), HasSubstr("scan: line 9: 'z' is 'b', not a number"));
    EXPECT_THAT(with("WIDTH 1\nDATA ascii\n1 2 300 4\n"), HasSubstr("'4' stands after the last field"));
    EXPECT_THAT(with("WIDTH 2\nDATA ascii\n10000 20000 30000\n"), HasSubstr("has 1 of the 2 points"));
    EXPECT_THAT(refused(MeshFormat::pcd, "FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nDATA ascii\n1 2\n"),
                HasSubstr("FIELDS has no 'z'"));
    EXPECT_THAT(message_of([] {
                    (void)to_range_scan(decode(MeshFormat::pcd, pcd_head + "WIDTH 1\nDATA ascii\nnan nan nan\n"),
                                        "scan");
                }),
                HasSubstr("scan: every point is marked as not measured"));
}

TEST(Pcd, absurd_sizes_are_refused_before_anything_is_allocated) {
    for (const auto* storage : {"ascii", "binary", "binary_compressed"})
        EXPECT_THAT(
            refused(MeshFormat::pcd, pcd_head + "WIDTH 2147483647\nHEIGHT 2147483647\nDATA " + storage + "\n12345678"),
            HasSubstr("WIDTH x HEIGHT is 2147483647 x 2147483647, but only 8 bytes of data are left"))
            << storage;
    auto text = lattice("binary_compressed");
    EXPECT_THAT(refused(MeshFormat::pcd, text.substr(0, text.size() - 1)),
                HasSubstr("the compressed data has 75 bytes but only 74 are left"));
    const auto sizes = text.find("binary_compressed\n") + 18;
    text[sizes + 4] = 1;
    EXPECT_THAT(refused(MeshFormat::pcd, text),
                HasSubstr("the compressed data promises 1 byte, but WIDTH x HEIGHT points need 72"));
    text = lattice("binary_compressed");
    text[sizes + 8] = '\xFF';  // a repetition of what has not been
    EXPECT_THAT(refused(MeshFormat::pcd, text), HasSubstr("the compressed data is damaged"));
}

TEST(Pcd, fields_that_would_take_more_than_256_mb_are_refused_before_they_are_unpacked) {
    // 32 MB of zeros in 380 kB of LZF: a field of 10000 bytes for each of 3400 points is 272 MB as numbers.
    constexpr std::uint32_t points = 3400, unpacked = points * (3 * 4 + 10000), packed = unpacked / 88 + 1;
    std::string text =
        "FIELDS x y z bomb\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 10000\nWIDTH 3400\nDATA binary_compressed\n";
    for (const std::uint32_t size : {packed, unpacked})
        for (int k = 0; k < 4; ++k) text += static_cast<char>(size >> (8 * k) & 0xFFU);
    EXPECT_THAT(refused(MeshFormat::pcd, text + std::string(packed, '\0')),
                HasSubstr("3400 points of 10003 values take 272081600 bytes of memory"));
}

TEST(Pcd, a_scan_has_no_attributes_decoded_and_a_mesh_has) {
    const std::string file =
        "FIELDS x y z q\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 1\nDATA ascii\n1 2 3 4\n";
    EXPECT_EQ(decode(MeshFormat::pcd, file).mesh.attributes.size(), 1U);
    const auto bare =
        decode_mesh(MeshFormat::pcd, bytes_of(file), "scan", LengthUnit::millimetre, MeshParts::without_attributes);
    EXPECT_TRUE(bare.mesh.attributes.empty());
    EXPECT_EQ(bare.mesh.vertices_mm, decode(MeshFormat::pcd, file).mesh.vertices_mm);
}

// ---- range scans

TEST(RangeScanFiles, texture_positions_per_corner_become_one_per_point) {
    const TemporaryFolder folder;
    base::write_atomically(
        folder / "a.obj",
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nvt 0.1 0.2\nvt 0.3 0.4\nvt 0.5 0.6\nvt 0.7 0.8\n"
        "f 1/1 2/2 3/3\nf 1/4 3/3 2/2\n");
    base::write_atomically(folder / "a.mtl", "newmtl a\nmap_Kd face 1.png\n");
    const auto scan = read_range_scan(folder / "a.obj", LengthUnit::centimetre);
    EXPECT_FALSE(scan.organised());
    EXPECT_EQ(scan.points_mm[3], Point(50, 50, 50));
    EXPECT_THAT(scan.texture_coordinates, ElementsAre(TextureCoordinate(0.1, 0.2), TextureCoordinate(0.3, 0.4),
                                                      TextureCoordinate(0.5, 0.6), TextureCoordinate(0, 0)));
    EXPECT_TRUE(scan.faces.texture_corners.empty());
    EXPECT_EQ(scan.texture_seam_points, 1U);  // corners 1 and 4 of point 0
    EXPECT_EQ(scan.faces.size(), 2U);
    EXPECT_EQ(scan.texture_file, "face 1.png");
}

// ---- VTP

Mesh full_mesh(bool corner_texture) {
    Mesh mesh;
    for (int i = 0; i < 6; ++i) mesh.vertices_mm.emplace_back(1.0 / 3.0 + i, -std::sqrt(2.0) * i, 1e-17 * (i + 1));
    mesh.faces.add(std::array<std::uint32_t, 3>{0, 1, 2});
    mesh.faces.add(std::array<std::uint32_t, 5>{5, 4, 3, 2, 1});
    for (std::size_t i = 0; i < 6; ++i) {
        mesh.colours.push_back({static_cast<std::uint8_t>(40 * i), 255, static_cast<std::uint8_t>(i)});
        mesh.texture_coordinates.emplace_back(static_cast<double>(i) / 7.0, 1.0 / 3.0);
    }
    if (corner_texture)
        for (const auto corner : mesh.faces.corners) mesh.faces.texture_corners.push_back(5 - corner);
    mesh.attributes.push_back({"displacement <mm> & \"more\"", 3, {}});
    mesh.attributes.push_back({"distance_mm", 1, {}});
    for (auto& attribute : mesh.attributes)
        for (std::size_t i = 0; i < 6 * static_cast<std::size_t>(attribute.components); ++i)
            attribute.values.push_back(1.0 / (static_cast<double>(i) + 3.0));
    return mesh;
}

void expect_same(const Mesh& read, const Mesh& written) {
    EXPECT_EQ(read.vertices_mm, written.vertices_mm);
    EXPECT_EQ(read.faces.corners, written.faces.corners);
    EXPECT_EQ(read.faces.first, written.faces.first);
    EXPECT_EQ(read.faces.texture_corners, written.faces.texture_corners);
    EXPECT_EQ(read.texture_coordinates, written.texture_coordinates);
    EXPECT_EQ(read.colours, written.colours);
    ASSERT_EQ(read.attributes.size(), written.attributes.size());
    for (std::size_t i = 0; i < read.attributes.size(); ++i) {
        EXPECT_EQ(read.attributes[i].name, written.attributes[i].name);
        EXPECT_EQ(read.attributes[i].components, written.attributes[i].components);
        EXPECT_EQ(read.attributes[i].values, written.attributes[i].values);
    }
}

TEST(Vtp, everything_comes_back) {
    const TemporaryFolder folder;
    for (const bool corner_texture : {false, true}) {
        const auto mesh = full_mesh(corner_texture);
        write_mesh(folder / "mesh.vtp", mesh);
        expect_same(read_mesh(folder / "mesh.vtp"), mesh);
    }
    Mesh cloud;
    cloud.vertices_mm = {{1, 2, 3}, {4, 5, 6}};
    write_mesh(folder / "cloud.vtp", cloud);
    expect_same(read_mesh(folder / "cloud.vtp"), cloud);
}

std::string vtp(const std::string& arrays, const std::string& points = "3") {
    return "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><Piece "
           "NumberOfPoints=\"" +
           points + "\">" + arrays + "</Piece></PolyData></VTKFile>";
}
const std::string ascii_points =
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0\n0 1 "
    "0</DataArray></Points>";

TEST(Vtp, ascii_arrays_and_strips_are_read) {
    const auto mesh = decode(MeshFormat::vtp,
                             vtp("<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">"
                                 "0 0 0 1 0 0 0 1 0 1 1 0</DataArray></Points><Strips>"
                                 "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
                                 "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray></Strips>",
                                 "4"))
                          .mesh;
    EXPECT_THAT(mesh.faces.corners, ElementsAre(0, 1, 2, 1, 3, 2));
}

TEST(Vtp, errors_name_the_array_and_the_value) {
    const auto with = [](const std::string& arrays) { return refused(MeshFormat::vtp, vtp(arrays)); };
    EXPECT_THAT(refused(MeshFormat::vtp, "<VTKFile type=\"ImageData\"/>"),
                HasSubstr("scan: VTKFile type is 'ImageData'"));
    EXPECT_THAT(refused(MeshFormat::vtp, "<VTKFile"), HasSubstr("scan: byte "));
    EXPECT_THAT(refused(MeshFormat::vtp, "<html/>"), HasSubstr("has no element VTKFile"));
    EXPECT_THAT(refused(MeshFormat::vtp, "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"/>"),
                HasSubstr("compressor is 'vtkLZ4DataCompressor'"));
    EXPECT_THAT(refused(MeshFormat::vtp, "<VTKFile type=\"PolyData\"><PolyData/></VTKFile>"),
                HasSubstr("PolyData has no Piece"));
    EXPECT_THAT(with(""), HasSubstr("array 'Points' is missing"));
    EXPECT_THAT(refused(MeshFormat::vtp, vtp(ascii_points, "4")),
                HasSubstr("array 'Points' has 3 entries, but NumberOfPoints is 4"));
    EXPECT_THAT(refused(MeshFormat::vtp, vtp(ascii_points, "many")), HasSubstr("NumberOfPoints is 'many'"));
    EXPECT_THAT(
        with(
            "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 a 0</DataArray></Points>"),
        HasSubstr("array 'Points': value 1 is 'a'"));
    EXPECT_THAT(
        with("<Points><DataArray type=\"Float32\" NumberOfComponents=\"0\" format=\"ascii\">0</DataArray></Points>"),
        HasSubstr("NumberOfComponents is '0'"));
    EXPECT_THAT(with("<Points><DataArray type=\"Half\" format=\"ascii\">0</DataArray></Points>"),
                HasSubstr("type is 'Half'"));
    EXPECT_THAT(with("<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" "
                     "offset=\"99\"/></Points>"),
                HasSubstr("offset is '99', outside the 0 bytes"));
    EXPECT_THAT(with("<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
                     "format=\"binary\">/////w==</DataArray></Points>"),
                HasSubstr("array 'Points' is truncated"));
    EXPECT_THAT(
        with(ascii_points + "<Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 3</DataArray>"
                            "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys>"),
        HasSubstr("Polys: cell 0 names vertex 3; there are vertices 0 to 2"));
    EXPECT_THAT(
        with(ascii_points + "<Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>"
                            "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">9</DataArray></Polys>"),
        HasSubstr("Polys: offset of cell 0 is 9; there are 3 corners"));
    EXPECT_THAT(with(ascii_points +
                     "<PointData><DataArray type=\"Float32\" Name=\"d\" format=\"ascii\">1 2</DataArray></PointData>"),
                HasSubstr("array 'd' has 2 entries, but NumberOfPoints is 3"));
}

/// A file of `points` points at the origin: Points, and `copies` further arrays, share one compressed block of zeros.
std::string compressed_vtp(std::uint64_t points, int copies) {
    const std::vector<std::uint8_t> zeros(static_cast<std::size_t>(3 * points));
    auto packed_size = compressBound(static_cast<uLong>(zeros.size()));
    std::string packed(packed_size, '\0');
    EXPECT_EQ(compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size, zeros.data(),
                        static_cast<uLong>(zeros.size()), 9),
              Z_OK);
    packed.resize(packed_size);
    const auto array = [](const std::string& name) {
        return "<DataArray type=\"UInt8\" Name=\"" + name +
               "\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/>";
    };
    std::string text =
        "<VTKFile type=\"PolyData\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece "
        "NumberOfPoints=\"" +
        std::to_string(points) + "\"><Points>" + array("Points") + "</Points><PointData>";
    for (int k = 0; k < copies; ++k) text += array("copy" + std::to_string(k));
    text += "</PointData></Piece></PolyData><AppendedData encoding=\"raw\">_";
    for (const std::uint64_t word : {std::uint64_t{1}, 3 * points, std::uint64_t{0}, std::uint64_t{packed.size()}})
        append(text, word);
    return text + packed + "</AppendedData></VTKFile>";
}

// A million points of three values take 24 MB; 256 MB hold eleven such arrays.
TEST(Vtp, arrays_that_share_compressed_data_do_not_get_more_memory_than_the_limit) {
    const auto at_limit = compressed_vtp(1'000'000, 10), above = compressed_vtp(1'000'000, 400);
    ASSERT_LT(above.size(), 64U << 10U);
    EXPECT_EQ(decode(MeshFormat::vtp, at_limit).mesh.attributes.size(), 10U);
    EXPECT_THAT(refused(MeshFormat::vtp, above),
                HasSubstr("scan: array 'copy10' has 3000000 values; with it all arrays take more than 256 MB"));
    // Who asks for no attributes has none decoded.
    EXPECT_EQ(
        decode_mesh(MeshFormat::vtp, bytes_of(above), "scan", LengthUnit::millimetre, MeshParts::without_attributes)
            .mesh.vertices_mm.size(),
        1'000'000U);
}

TEST(Vtp, the_limit_that_is_said_is_the_one_that_applies) {
    // Eight times a file of 36 MB is 288 MB, more than the 256 MB that any file may have; twelve arrays fit.
    EXPECT_THAT(refused(MeshFormat::vtp, compressed_vtp(1'000'000, 400) + std::string(std::size_t{36} << 20U, ' ')),
                HasSubstr("scan: array 'copy11' has 3000000 values; with it all arrays take more than 288 MB"));
}

TEST(Vtp, an_array_that_ends_inside_a_value_is_refused) {
    std::string text =
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\"><Points><DataArray type=\"Float32\" "
        "NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece></PolyData>"
        "<AppendedData encoding=\"raw\">_";
    append(text, std::uint32_t{39});
    EXPECT_THAT(refused(MeshFormat::vtp, text + std::string(39, '\0') + "</AppendedData></VTKFile>"),
                HasSubstr("scan: array 'Points' has 39 bytes, not a multiple of the 4 of a value"));
}

TEST(Vtp, a_compressed_array_of_another_length_than_the_points_is_refused_by_its_header) {
    auto text = compressed_vtp(1'000'000, 1);
    const std::string stated = "NumberOfPoints=\"1000000\"";
    text.replace(text.find(stated), stated.size(), "NumberOfPoints=\"1000\"");
    text.replace(text.size() - 500, 400, 400, 'x');  // nor could it be unpacked
    EXPECT_THAT(refused(MeshFormat::vtp, text),
                HasSubstr("array 'Points' has 1000000 entries, but NumberOfPoints is 1000"));
}

TEST(Vtp, a_compressed_array_of_no_blocks_is_no_array_of_three_points) {
    // In base64: zero blocks, whatever stands behind.
    EXPECT_THAT(refused(MeshFormat::vtp,
                        "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData>"
                        "<Piece NumberOfPoints=\"3\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
                        "format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><PointData><DataArray type=\"UInt8\" "
                        "Name=\"d\" format=\"binary\">AAAAAAMAAAAAAAAACwAAAA==</DataArray></PointData></Piece>"
                        "</PolyData></VTKFile>"),
                HasSubstr("array 'd' has 0 entries, but NumberOfPoints is 3"));
}

TEST(Vtp, a_truncated_file_is_refused_wherever_it_is_cut) {
    const TemporaryFolder folder;
    write_mesh(folder / "mesh.vtp", full_mesh(true));
    const auto text = base::read_text(folder / "mesh.vtp");
    const auto data_end = text.rfind("\n</AppendedData>");
    for (std::size_t length = 0; length < data_end; length += 7)
        EXPECT_NE(refused(MeshFormat::vtp, text.substr(0, length)), "") << length;
}

}  // namespace
}  // namespace mimik::io
