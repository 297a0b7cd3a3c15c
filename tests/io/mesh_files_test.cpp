#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "geometry/vertex_attributes.h"
#include "io/mesh_io.h"
#include "io/texture_path.h"
#include "tests/io/files_testing.h"

namespace mimik::io {

using geometry::Mesh;
using geometry::Point;
using geometry::TextureCoordinate;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

MeshFile decode(MeshFormat format, const std::string& text, LengthUnit unit = LengthUnit::millimetre) {
    return decode_mesh(format, bytes_of(text), "scan", unit);
}

/// Doubles that no shorter type and no 16-digit text can hold, polygons of 3 to 5 corners, a vertex without a face.
Mesh odd_mesh() {
    Mesh mesh;
    for (int i = 0; i < 7; ++i)
        mesh.vertices_mm.emplace_back(1.0 / 3.0 + i, -std::sqrt(2.0) * i, 1e-17 * (i + 1) + (i % 2 ? 1e5 : 0.1));
    mesh.faces.add(std::array<std::uint32_t, 3>{0, 1, 2});
    mesh.faces.add(std::array<std::uint32_t, 4>{2, 3, 1, 0});
    mesh.faces.add(std::array<std::uint32_t, 5>{5, 4, 3, 2, 1});
    return mesh;
}

void add_vertex_texture(Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i)
        mesh.texture_coordinates.emplace_back(static_cast<double>(i) / 7.0, 1.0 / (static_cast<double>(i) + 3.0));
}

void add_corner_texture(Mesh& mesh) {
    mesh.texture_coordinates = {{0.1, 0.2}, {1.0 / 3.0, 0.5}, {0.9, 0.7}};
    for (std::size_t k = 0; k < mesh.faces.corners.size(); ++k)
        mesh.faces.texture_corners.push_back(static_cast<std::uint32_t>(k % 3));
}

void add_colours(Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i)
        mesh.colours.push_back({static_cast<std::uint8_t>(i * 37), static_cast<std::uint8_t>(255 - i), 1});
}

void add_attributes(Mesh& mesh) {
    for (const auto& [name, components] : std::vector<std::pair<std::string, int>>{
             {"distance_mm", 1}, {"uncertainty", 2}, {"displacement_mm", 3}, {"quaternion", 4}, {"weights", 6}}) {
        auto& attribute = mesh.attributes.emplace_back();
        attribute.name = name;
        attribute.components = components;
        for (std::size_t i = 0; i < static_cast<std::size_t>(components) * mesh.vertices_mm.size(); ++i)
            attribute.values.push_back(1.0 / (static_cast<double>(i) + 7.0));
    }
}

std::vector<TextureCoordinate> corner_positions(const Mesh& mesh) {
    std::vector<TextureCoordinate> positions;
    for (const auto k : mesh.faces.texture_corners) positions.push_back(mesh.texture_coordinates[k]);
    return positions;
}

void expect_same_surface(const Mesh& read, const Mesh& written) {
    EXPECT_EQ(read.vertices_mm, written.vertices_mm);
    EXPECT_EQ(read.faces.corners, written.faces.corners);
    EXPECT_EQ(read.faces.first, written.faces.first);
}

void expect_same_attributes(const Mesh& read, const Mesh& written) {
    ASSERT_EQ(read.attributes.size(), written.attributes.size());
    for (std::size_t i = 0; i < written.attributes.size(); ++i) {
        EXPECT_EQ(read.attributes[i].name, written.attributes[i].name);
        EXPECT_EQ(read.attributes[i].components, written.attributes[i].components);
        EXPECT_EQ(read.attributes[i].values, written.attributes[i].values);
    }
}

// ---- PLY

void expect_corners_come_back(const Mesh& mesh, bool binary) {
    const TemporaryFolder folder;
    MeshWriteOptions options;
    options.binary = binary;
    write_mesh(folder / "mesh.ply", mesh, options);
    const auto read = read_mesh(folder / "mesh.ply");
    expect_same_surface(read, mesh);
    EXPECT_EQ(corner_positions(read), corner_positions(mesh));
}

class PlyRoundTrip : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Encodings, PlyRoundTrip, testing::Bool(),
                         [](const auto& test) { return std::string(test.param ? "binary" : "ascii"); });

TEST_P(PlyRoundTrip, every_double_colour_attribute_and_texture_position_comes_back) {
    const TemporaryFolder folder;
    auto mesh = odd_mesh();
    add_vertex_texture(mesh);
    add_colours(mesh);
    add_attributes(mesh);
    MeshWriteOptions options;
    options.binary = GetParam();
    options.texture_file = "face of 3.png";
    write_mesh(folder / "mesh.ply", mesh, options);
    const auto read = read_mesh_file(folder / "mesh.ply");
    expect_same_surface(read.mesh, mesh);
    expect_same_attributes(read.mesh, mesh);
    EXPECT_EQ(read.mesh.texture_coordinates, mesh.texture_coordinates);
    EXPECT_TRUE(read.mesh.faces.texture_corners.empty());
    EXPECT_EQ(read.mesh.colours, mesh.colours);
    EXPECT_EQ(read.texture_file, "face of 3.png");
}

TEST_P(PlyRoundTrip, texture_positions_per_corner_come_back) {
    auto mesh = odd_mesh();
    add_corner_texture(mesh);
    expect_corners_come_back(mesh, GetParam());
}

TEST_P(PlyRoundTrip, a_polygon_too_large_for_a_byte_count_comes_back) {
    Mesh mesh;
    std::vector<std::uint32_t> ring;
    for (std::uint32_t i = 0; i < 300; ++i) {
        mesh.vertices_mm.emplace_back(i, i * i, 0);
        ring.push_back(i);
    }
    mesh.faces.add(ring);
    add_corner_texture(mesh);
    expect_corners_come_back(mesh, GetParam());
}

TEST(Ply, rows_without_a_property_are_refused_before_anything_is_allocated) {
    for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
        EXPECT_THAT(message_of([&] {
                        (void)decode(MeshFormat::ply, std::string("ply\nformat ") + encoding +
                                                          " 1.0\nelement vertex 1000000000000\nend_header\n");
                    }),
                    HasSubstr("scan: element 'vertex': the header promises 1000000000000 rows but no property"))
            << encoding;
}

TEST(Ply, ascii_with_other_elements_lists_and_normals_is_read_by_name) {
    const auto file =
        decode(MeshFormat::ply,
               "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\ncomment TextureFile bs000.png\r\n"
               "element camera 1\r\nproperty float view_x\r\nproperty list uchar int ids\r\n"
               "element vertex 3\r\nproperty float nx\r\nproperty float z\r\nproperty float y\r\nproperty float x\r\n"
               "property uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\nproperty uchar alpha\r\n"
               "property float s\r\nproperty float t\r\nproperty float quality\r\n"
               "element face 1\r\nproperty uchar flags\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
               "0.5 2 7 8\r\n"
               "0 3 2 1 255 0 7 255 0.25 0.75 9\r\n"
               "0 6 5 4 1 2 3 255 0 1 8\r\n"
               "\r\n"
               "0 +9 8e0 7.0 4 5 6 255 1 0 7\r\n"
               "1 3 2 0 1\r\n");
    EXPECT_THAT(file.mesh.vertices_mm, ElementsAre(Point(1, 2, 3), Point(4, 5, 6), Point(7, 8, 9)));
    EXPECT_THAT(file.mesh.faces.corners, ElementsAre(2, 0, 1));
    EXPECT_EQ(file.mesh.texture_coordinates[0], TextureCoordinate(0.25, 0.75));
    EXPECT_EQ(file.mesh.colours[0], (std::array<std::uint8_t, 3>{255, 0, 7}));
    ASSERT_EQ(file.mesh.attributes.size(), 1U);
    EXPECT_EQ(file.mesh.attributes[0].name, "quality");
    EXPECT_THAT(file.mesh.attributes[0].values, ElementsAre(9, 8, 7));
    EXPECT_EQ(file.texture_file, "bs000.png");
}

TEST(Ply, big_endian_numbers_are_turned_round) {
    std::string text =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty short z\n"
        "element face 1\nproperty list uchar ushort vertex_indices\nend_header\n";
    const auto big = [&](auto value) {
        auto raw = std::bit_cast<std::array<char, sizeof(value)>>(value);
        text.append(raw.rbegin(), raw.rend());
    };
    for (int i = 0; i < 3; ++i) {
        big(1.5F + static_cast<float>(i));
        big(-2.25F);
        big(static_cast<std::int16_t>(-300 - i));
    }
    text += '\3';
    for (std::uint16_t i = 0; i < 3; ++i) big(i);
    const auto mesh = decode(MeshFormat::ply, text).mesh;
    EXPECT_THAT(mesh.vertices_mm,
                ElementsAre(Point(1.5, -2.25, -300), Point(2.5, -2.25, -301), Point(3.5, -2.25, -302)));
    EXPECT_THAT(mesh.faces.corners, ElementsAre(0, 1, 2));
}

TEST(Ply, lengths_in_other_units_become_millimetres) {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\n"
        "end_header\n0.1 0.2 0.3\n";
    EXPECT_EQ(decode(MeshFormat::ply, text, LengthUnit::metre).mesh.vertices_mm[0],
              Point(0.1 * 1000, 0.2 * 1000, 0.3 * 1000));
    EXPECT_EQ(decode(MeshFormat::ply, text, LengthUnit::centimetre).mesh.vertices_mm[0],
              Point(0.1 * 10, 0.2 * 10, 0.3 * 10));
}

std::string ply_xyz(const std::string& format, const std::string& count, const std::string& rest) {
    return "ply\nformat " + format + " 1.0\nelement vertex " + count +
           "\nproperty float x\nproperty float y\nproperty float z\n" + rest;
}

TEST(Ply, errors_name_the_file_the_place_the_value_and_the_mend) {
    const auto refused = [](const std::string& text) {
        return message_of([&] { (void)decode(MeshFormat::ply, text); });
    };
    EXPECT_EQ(refused("solid"), "scan: does not start with 'ply'; it is not a PLY file");
    EXPECT_EQ(refused("ply\nformat ascii 1.0\n"), "scan: the header has no 'end_header' line; the file is truncated");
    EXPECT_THAT(refused("ply\nformat excel 1.0\n"), HasSubstr("scan: line 2: format is 'excel'"));
    EXPECT_THAT(refused(ply_xyz("ascii", "-3", "end_header\n")),
                HasSubstr("line 3: the count of element 'vertex' is '-3'"));
    EXPECT_THAT(refused(ply_xyz("ascii", "2", "end_header\n1 2 3\n4 five 6\n")),
                HasSubstr("scan: line 9: 'y' is 'five', not a number"));
    EXPECT_THAT(refused(ply_xyz("ascii", "2", "end_header\n1 2 3\n4 500\n")),
                HasSubstr("scan: line 9: row of element 'vertex' ends before 'z'"));
    EXPECT_THAT(refused(ply_xyz("ascii", "1", "end_header\n1 2 3 4\n")),
                HasSubstr("scan: line 8: '4' stands after the last property"));
    EXPECT_THAT(refused(ply_xyz("ascii", "3", "end_header\n1 2 3\n4000000 500000 6000000\n")),
                HasSubstr("has 2 of the 3 rows that the header promises"));
    EXPECT_THAT(refused(ply_xyz("ascii", "1", "end_header\n1 nan 3\n")),
                HasSubstr("scan: every point is marked as not measured (NaN)"));
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    EXPECT_THAT(refused(ply_xyz("ascii", "3", face + "0 0 0\n1 nan 3\n0 1 0\n3 0 1 2\n")),
                HasSubstr("vertex 1 (counted from 0) is a corner of a face and is (1, nan, 3), not a finite position"));
    EXPECT_THAT(refused(ply_xyz("ascii", "3", face + "0 0 0\n1 1e999 3\n0 1 0\n3 0 1 2\n")), HasSubstr("(1, inf, 3)"));
    EXPECT_THAT(
        refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n"),
        HasSubstr("has no property 'z'"));
    EXPECT_THAT(refused(ply_xyz("ascii", "1", "property float x\nend_header\n")),
                HasSubstr("two properties named 'x'"));
    EXPECT_THAT(
        refused(ply_xyz("ascii", "1",
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n3 0 1 0\n")),
        HasSubstr("face 0 names vertex 1; there are vertices 0 to 0"));
    EXPECT_THAT(refused(ply_xyz("ascii", "0", "end_header\n")), HasSubstr("there is no vertex in it"));
    EXPECT_THAT(refused(ply_xyz("ascii", "0", "property float d_x\nproperty float d_y\nend_header\n")),
                HasSubstr("there is no vertex in it"));
}

TEST(Ply, absurd_counts_are_refused_before_anything_is_allocated) {
    const auto refused = [](const std::string& text) {
        return message_of([&] { (void)decode(MeshFormat::ply, text); });
    };
    for (const auto* format : {"ascii", "binary_little_endian", "binary_big_endian"})
        EXPECT_THAT(refused(ply_xyz(format, "9000000000000000000", "end_header\n0 0 0\n")),
                    HasSubstr("element 'vertex': the header promises 9000000000000000000 rows"));
    EXPECT_THAT(refused(ply_xyz("binary_little_endian", "99999999999999999999999", "end_header\n")),
                HasSubstr("not a whole number"));
    const std::string one_vertex(12, '\0');
    EXPECT_THAT(refused(ply_xyz("binary_little_endian", "1",
                                "element face 1\nproperty list uint double vertex_indices\nend_header\n" + one_vertex +
                                    std::string("\xFF\xFF\xFF\xFF\0\0", 6))),
                HasSubstr("'vertex_indices': 34359738360 bytes are needed but 2 are left"));
    EXPECT_THAT(
        refused(ply_xyz("ascii", "1",
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n1e18 0 0\n")),
        HasSubstr("list 'vertex_indices' has count 1e+18"));
    EXPECT_THAT(refused("ply\nformat ascii 1.0\nelement vertex 1\n" + std::string(50'000'000, 'x')),
                HasSubstr("line 4: 'xxxx"));
}

// ---- OBJ

TEST(Obj, every_double_colour_and_texture_position_comes_back) {
    const TemporaryFolder folder;
    auto mesh = odd_mesh();
    add_vertex_texture(mesh);
    add_colours(mesh);
    MeshWriteOptions options;
    options.texture_file = "bs000_N_N_0.png";
    write_mesh(folder / "mesh.obj", mesh, options);
    const auto read = read_mesh_file(folder / "mesh.obj");
    expect_same_surface(read.mesh, mesh);
    EXPECT_EQ(read.mesh.texture_coordinates, mesh.texture_coordinates);
    EXPECT_TRUE(read.mesh.faces.texture_corners.empty());
    EXPECT_EQ(read.mesh.colours, mesh.colours);
    EXPECT_EQ(read.texture_file, "bs000_N_N_0.png");
    EXPECT_THAT(base::read_text(folder / "mesh.mtl"), HasSubstr("map_Kd bs000_N_N_0.png"));
}

TEST(Obj, texture_positions_per_corner_come_back_with_their_indices) {
    const TemporaryFolder folder;
    auto mesh = odd_mesh();
    add_corner_texture(mesh);
    write_mesh(folder / "mesh.obj", mesh);
    const auto read = read_mesh(folder / "mesh.obj");
    expect_same_surface(read, mesh);
    EXPECT_EQ(read.texture_coordinates, mesh.texture_coordinates);
    EXPECT_EQ(read.faces.texture_corners, mesh.faces.texture_corners);
}

TEST(Obj, polygons_negative_indices_joined_lines_and_foreign_statements_are_read) {
    const auto mesh =
        decode(MeshFormat::obj,
               "# a comment\r\no face\r\nv 0 0 0\r\nv 1 0 0 1.0\r\nv 1 1 0\r\nv 0 1 0\r\nvt 0.5 0.25\r\nvn 0 0 1\r\n"
               "s off\r\nusemtl skin\r\nf 1/1/1 2/1/1 3//1 4 # quad\r\nf -4 -3 \\\r\n-2\r\nl 1 2\r\n")
            .mesh;
    EXPECT_EQ(mesh.vertices_mm.size(), 4U);
    EXPECT_THAT(mesh.faces.corners, ElementsAre(0, 1, 2, 3, 0, 1, 2));
    EXPECT_THAT(mesh.faces.first, ElementsAre(0, 4, 7));
    // Corners without a texture index get a position (0, 0) of their own.
    EXPECT_THAT(mesh.faces.texture_corners, ElementsAre(0, 0, 1, 1, 1, 1, 1));
    EXPECT_THAT(mesh.texture_coordinates, ElementsAre(TextureCoordinate(0.5, 0.25), TextureCoordinate(0, 0)));
}

TEST(Obj, vertex_colours_may_be_reals_or_bytes) {
    const std::array<std::uint8_t, 3> wanted = {255, 128, 0};
    EXPECT_EQ(decode(MeshFormat::obj, "v 0 0 0 1 0.502 0\n").mesh.colours[0], wanted);
    EXPECT_EQ(decode(MeshFormat::obj, "v 0 0 0 255 128 0\n").mesh.colours[0], wanted);
}

TEST(Obj, errors_name_the_file_the_line_and_the_value) {
    const auto refused = [](const std::string& text) {
        return message_of([&] { (void)decode(MeshFormat::obj, text); });
    };
    EXPECT_THAT(refused("v 0 0\n"), HasSubstr("scan: line 1: a vertex has 2 numbers"));
    EXPECT_THAT(refused("v 0 0 0\nv 0 two 0\n"), HasSubstr("scan: line 2: y is 'two', not a number"));
    EXPECT_THAT(refused("v 0 0 0\nv 0 nan 0\nv 1 0 0\nf 1 2 3\n"),
                HasSubstr("vertex 1 (counted from 0) is a corner of a face and is (0, nan, 0), not a finite position"));
    EXPECT_THAT(refused("v 0 0 0\nf 1 1 2\n"), HasSubstr("scan: line 2: vertex index is 2, but the file has 1"));
    EXPECT_THAT(refused("v 0 0 0\nf 1 1 0\n"), HasSubstr("scan: line 2: vertex index is 0"));
    EXPECT_THAT(refused("v 0 0 0\nf 1 1 -2\n"), HasSubstr("vertex index is -2; so far there are 1"));
    EXPECT_THAT(refused("v 0 0 0\nvt 0 0\nf 1/1 1/2 1/1\n"),
                HasSubstr("scan: line 3: texture index is 2, but the file has 1"));
    EXPECT_THAT(refused("v 0 0 0\nf 1 1 999999999999999999999\n"), HasSubstr("not a whole number"));
    EXPECT_THAT(refused("v 0 0 0\nf 1 1 4294967296\n"), HasSubstr("vertex index is 4294967296"));
    EXPECT_THAT(refused("vt up 0\nv 0 0 0\n"), HasSubstr("scan: line 1: texture u is 'up'"));
    EXPECT_THAT(refused(""), HasSubstr("there is no vertex in it"));
}

// ---- names and parts

TEST(MeshFiles, a_texture_name_that_leads_out_of_the_folder_is_refused) {
    for (const auto* name : {"../secret.png", "/etc/passwd", "a/b.png", "..\\x.png", "C:\\x.png", "..", "a\nb.png"})
        EXPECT_THAT(message_of([&] { (void)checked_texture_name(name, "scan.obj"); }),
                    HasSubstr("scan.obj: texture name is"))
            << name;
    EXPECT_EQ(checked_texture_name("./face 1.png", "scan.obj"), "face 1.png");

    const TemporaryFolder folder;
    base::write_atomically(folder / "a.obj", "mtllib a.mtl\nv 0 0 0\n");
    base::write_atomically(folder / "a.mtl", "newmtl x\nmap_Kd -s 1 1 1 ../../x.png\n");
    EXPECT_THAT(message_of([&] { (void)read_mesh_file(folder / "a.obj"); }),
                HasSubstr("a.mtl: texture name is '../../x.png'"));
    EXPECT_EQ(read_mesh(folder / "a.obj").vertices_mm.size(), 1U);
    base::write_atomically(folder / "b.obj", "mtllib ../b.mtl\nv 0 0 0\n");
    EXPECT_THAT(message_of([&] { (void)read_mesh_file(folder / "b.obj"); }),
                HasSubstr("b.obj: texture name is '../b.mtl'"));
}

TEST(MeshFiles, a_texture_name_that_cannot_be_used_leaves_the_surface_on_request) {
    const TemporaryFolder folder;
    base::write_atomically(folder / "a.obj", "mtllib a.mtl\nv 0 0 0\n");
    base::write_atomically(folder / "a.mtl", "newmtl x\nmap_Kd C:\\scans\\face.jpg\n");
    const auto file = read_mesh_file(folder / "a.obj", LengthUnit::millimetre, MeshParts::all, BadTexture::report);
    EXPECT_EQ(file.mesh.vertices_mm.size(), 1U);
    EXPECT_EQ(file.texture_file, "");
    EXPECT_THAT(file.material_files, ElementsAre("a.mtl"));
    EXPECT_THAT(file.texture_error, HasSubstr("a.mtl: texture name is 'C:\\scans\\face.jpg'; put the image"));
}

TEST(MeshFiles, a_material_file_that_the_system_will_not_look_for_takes_the_texture_and_not_the_surface) {
    const TemporaryFolder folder;
    std::filesystem::create_symlink("loop", folder / "loop");
    std::string too_long;  // each part is allowed, the whole is more than Linux takes
    for (int k = 0; k < 16; ++k) too_long += std::string(250, 'x') + "/";
    for (const auto& name : {std::string("loop"), too_long + "a.mtl"}) {
        base::write_atomically(folder / "a.obj", "mtllib " + name + "\nv 0 0 0\n");
        const auto file = read_mesh_file(folder / "a.obj");
        EXPECT_EQ(file.mesh.vertices_mm.size(), 1U) << name;
        EXPECT_EQ(file.texture_file, "") << name;
    }
}

TEST(MeshFiles, an_unknown_extension_is_refused_with_those_there_are) {
    EXPECT_THAT(message_of([] { (void)mesh_format("scan.xyz"); }),
                HasSubstr("scan.xyz: extension '.xyz' is no mesh format; there are .ply, .obj"));
    EXPECT_EQ(mesh_format("SCAN.PLY"), MeshFormat::ply);
}

TEST(MeshFiles, parts_that_do_not_fit_together_are_not_written) {
    const TemporaryFolder folder;
    const auto refused = [&](auto change) {
        auto mesh = odd_mesh();
        change(mesh);
        const auto message = message_of([&] { write_mesh(folder / "mesh.ply", mesh); });
        EXPECT_FALSE(std::filesystem::exists(folder / "mesh.ply"));
        return message;
    };
    EXPECT_THAT(refused([](Mesh& m) { m.colours.resize(2); }), HasSubstr("2 colours for 7 vertices"));
    EXPECT_THAT(refused([](Mesh& m) { m.texture_coordinates.resize(2); }),
                HasSubstr("2 texture positions for 7 vertices"));
    EXPECT_THAT(refused([](Mesh& m) { m.faces.corners[0] = 7; }), HasSubstr("a face names vertex 7 of 7"));
    EXPECT_THAT(refused([](Mesh& m) {
                    m.attributes.push_back({"d", 3, {1.0}});
                }),
                HasSubstr("attribute 'd' has 1 value for"));
    EXPECT_THAT(refused([](Mesh& m) { m.vertices_mm[3].x() = std::nan(""); }),
                HasSubstr("vertex 3 is not a finite position"));
}

TEST(MeshFiles, two_attributes_of_one_name_are_written_in_no_format_and_setting_one_replaces_it) {
    const TemporaryFolder folder;
    auto mesh = odd_mesh();
    mesh.attributes.push_back({"d", 1, std::vector<double>(7, 1.0)});
    geometry::set_attribute(mesh, {"d", 1, std::vector<double>(7, 2.0)});
    write_mesh(folder / "once.vtp", mesh);
    const auto read = read_mesh(folder / "once.vtp");
    ASSERT_EQ(read.attributes.size(), mesh.attributes.size());
    EXPECT_EQ(read.attributes.back().values.front(), 2.0);
    mesh.attributes.push_back(mesh.attributes.back());
    for (const auto* name : {"a.ply", "a.vtp", "a.obj", "a.stl"}) {
        EXPECT_THAT(message_of([&] { write_mesh(folder / name, mesh); }), HasSubstr("two attributes are called 'd'"));
        EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
    }
}

TEST(MeshFiles, a_texture_may_lie_in_a_folder_below_the_mesh_and_nowhere_else) {
    const TemporaryFolder folder;
    base::write_atomically(folder / "a.obj", "mtllib mat/./a.mtl\nv 0 0 0\n");
    base::write_atomically(folder / "mat/a.mtl", "newmtl x\nmap_Kd tex/skin 1.png\n");
    EXPECT_EQ(read_mesh_file(folder / "a.obj").texture_file, "mat/tex/skin 1.png");
    EXPECT_EQ(checked_texture_path("./tex/x.png", "m"), "tex/x.png");
    for (const auto* name : {"/x.png", "tex/../x.png", "..", "tex//x.png", "tex/", "C:/x.png", "tex\\x.png", "", "."})
        EXPECT_THAT(message_of([&] { (void)checked_texture_path(name, "m.obj"); }), HasSubstr("m.obj: texture name is"))
            << name;
    EXPECT_THAT(message_of([&] { (void)checked_texture_name("tex/x.png", "m.obj"); }), HasSubstr("bare file name"));
}

TEST(MeshFiles, units_are_known_by_name) {
    EXPECT_EQ(millimetres_per(parse_length_unit("mm")), 1);
    EXPECT_EQ(millimetres_per(parse_length_unit("cm")), 10);
    EXPECT_EQ(millimetres_per(parse_length_unit("m")), 1000);
    EXPECT_EQ(millimetres_per(parse_length_unit("inch")), 25.4);
    EXPECT_THAT(message_of([] { (void)parse_length_unit("foot"); }),
                HasSubstr("unit 'foot' is not known; use mm, cm, m or inch"));
}

}  // namespace
}  // namespace mimik::io
