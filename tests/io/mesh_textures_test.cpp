#include <gmock/gmock.h>

#include "base/file.h"
#include "io/image.h"
#include "io/mesh_io.h"
#include "io/range_scan_io.h"
#include "io/texture_atlas.h"
#include "io/texture_path.h"
#include "tests/io/files_testing.h"

namespace mimik::io {
namespace {

using geometry::TextureCoordinate;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two triangles of one square with four texture positions; `first` and `second` stand before them.
std::string square(const std::string& head, const std::string& first, const std::string& second) {
    return head + "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n" + first + "f 1/1 2/2 3/3\n" +
           second + "f 1/1 3/3 4/4\n";
}

void put_image(const std::filesystem::path& file) { write_png(file, {1, 1, {200, 120, 90}}); }

class MeshTextures : public testing::Test {
protected:
    [[nodiscard]] MeshFile read(const std::string& mtl, const std::string& obj) const {
        base::write_atomically(folder_ / "a.mtl", mtl);
        base::write_atomically(folder_ / "a.obj", obj);
        return read_mesh_file(folder_ / "a.obj", LengthUnit::millimetre, MeshParts::all, BadTexture::report);
    }
    /// The image that a material's line `map_Kd written` gives.
    [[nodiscard]] std::string image(const std::string& written) const {
        const auto file = read("newmtl skin\nmap_Kd " + written + "\n", square("mtllib a.mtl\n", "usemtl skin\n", ""));
        return file.texture_file.empty() ? "error: " + file.texture_error : file.texture_file;
    }
    TemporaryFolder folder_;
};

TEST_F(MeshTextures, are_those_of_the_materials_in_use_and_not_the_first_of_the_library) {
    const std::string mtl = "newmtl eyes\nmap_Kd eyes.png\nnewmtl skin\nKd 1 1 1\nmap_Kd skin.png\n";
    auto file = read(mtl, square("mtllib a.mtl\n", "usemtl skin\n", ""));
    EXPECT_EQ(file.texture_file, "skin.png");
    EXPECT_THAT(file.face_textures, IsEmpty());
    file =
        read(mtl, square("mtllib a.mtl\n", "usemtl eyes\nusemtl SKIN\n", ""));  // other capitals, and one without faces
    EXPECT_EQ(file.texture_file, "skin.png");
    EXPECT_EQ(read(mtl, square("mtllib a.mtl\n", "", "")).texture_file, "eyes.png");  // no material is named
}

TEST_F(MeshTextures, of_several_materials_are_kept_per_face) {
    const std::string mtl = "newmtl a b\nmap_Kd 1.png\nnewmtl c\nmap_Kd 2.png\nnewmtl plain\nKd 1 0 0\n";
    auto file = read(mtl, square("mtllib a.mtl\n", "usemtl c\n", "usemtl a b\n"));
    EXPECT_EQ(file.texture_file, "");
    EXPECT_THAT(file.texture_files, ElementsAre("2.png", "1.png"));
    EXPECT_THAT(file.face_textures, ElementsAre(0U, 1U));
    file = read(mtl, square("mtllib a.mtl\n", "usemtl plain\n", "usemtl c\n"));
    EXPECT_EQ(file.texture_file, "2.png");
    EXPECT_THAT(file.face_textures, ElementsAre(no_picture, 0U));
    file = read(mtl, square("mtllib a.mtl\n", "usemtl nobody\n", "usemtl c\n"));
    EXPECT_THAT(file.face_textures, ElementsAre(no_picture, 0U));
    EXPECT_THAT(file.remarks, ElementsAre(HasSubstr("a.obj: material 'nobody' is in no material file of it")));
    file =
        read("newmtl x\nmap_Kd 1.png\nnewmtl y\nmap_Kd 1.png\n", square("mtllib a.mtl\n", "usemtl x\n", "usemtl y\n"));
    EXPECT_EQ(file.texture_file, "1.png");
    EXPECT_THAT(file.face_textures, IsEmpty());
}

TEST_F(MeshTextures, stand_in_any_of_several_libraries) {
    base::write_atomically(folder_ / "my lib.mtl", "newmtl b\nmap_Kd b.png\n");
    const auto mtl = "newmtl a\nmap_Kd a.png\n";
    for (const auto* head : {"mtllib a.mtl my lib.mtl\n", "mtllib my lib.mtl a.mtl\n",
                             "mtllib a.mtl\nmtllib my lib.mtl\n", "mtllib A.MTL\nmtllib C:\\scans\\my lib.mtl\n"}) {
        const auto file = read(mtl, square(head, "usemtl a\n", "usemtl b\n"));
        EXPECT_THAT(file.texture_files, ElementsAre("a.png", "b.png")) << head;
    }
    const auto file = read(mtl, square("mtllib lost.mtl\n", "usemtl a\n", ""));
    EXPECT_THAT(file.texture_files, IsEmpty());
    EXPECT_THAT(file.material_files, ElementsAre("lost.mtl"));
    EXPECT_THAT(file.remarks, ElementsAre(HasSubstr("material file 'lost.mtl' is not beside it")));
}

TEST_F(MeshTextures, are_found_beside_the_mesh_whatever_machine_named_them) {
    for (const auto* name : {"skin.png", "my face.png", "2.png", "Ähre 1.png"}) put_image(folder_ / name);
    put_image(folder_ / "Tex" / "deep.png");
    for (const auto* written :
         {"skin.png", "SKIN.PNG", "./skin.png", ".\\skin.png", "C:\\Users\\lab\\skin.png", "C:skin.png",
          "/home/lab/skin.png", "..\\textures\\skin.png", "../../skin.png", "\\\\server\\share\\skin.png",
          "gone/skin.png", "\"skin.png\"", "-s 1 1 1 skin.png", "-o 0 0 -bm 0.5 -clamp on skin.png",
          "-blendu off -blendv on -mm 0 1 -imfchan l skin.png", "-t 0 skin.png", "-texres 512 -cc on -boost 2 skin.png",
          "  skin.png  "})
        EXPECT_EQ(image(written), "skin.png") << written;
    for (const auto* written : {"my face.png", "-s 1 1 1 my face.png", "My%20Face.png", "D:\\a b\\my face.png"})
        EXPECT_EQ(image(written), "my face.png") << written;
    for (const auto* written : {"2.png", "-s 2.png", "-s 1 1 2.png"}) EXPECT_EQ(image(written), "2.png") << written;
    EXPECT_EQ(image("tex\\deep.png"), "Tex/deep.png");
    EXPECT_EQ(image("/mnt/scans/TEX/Deep.png"), "Tex/deep.png");
    EXPECT_EQ(image("Ähre 1.png"), "Ähre 1.png");
    EXPECT_EQ(image("gone.png"), "gone.png");  // where it should be
    EXPECT_THAT(image("C:\\gone.png"), HasSubstr("error: " + (folder_ / "a.mtl").string() + ": texture name is 'C:"));
    EXPECT_EQ(find_beside(folder_ / "Tex", "../skin.png"), "");
}

TEST_F(MeshTextures, are_moved_as_the_material_says) {
    const auto file =
        read("newmtl skin\nmap_Kd -o 0.25 0 -s 2 0.5 1 skin.png\n", square("mtllib a.mtl\n", "", "usemtl skin\n"));
    const auto& mesh = file.mesh;
    const auto uv = [&](std::size_t corner) { return mesh.texture_coordinates[mesh.faces.texture_corners[corner]]; };
    EXPECT_EQ(uv(2), TextureCoordinate(1, 1));  // a face without that material
    EXPECT_EQ(uv(4), TextureCoordinate(2.25, 0.5));
    EXPECT_EQ(uv(5), TextureCoordinate(0.25, 0.5));
}

TEST_F(MeshTextures, of_a_ply_belong_to_its_faces_by_number) {
    const std::string head =
        "ply\nformat ascii 1.0\ncomment TextureFile low.png\ncomment TextureFile C:\\x\\UP.png\nelement vertex 3\n"
        "property float x\nproperty float y\nproperty float z\nelement face 3\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    put_image(folder_ / "up.png");
    const auto read_ply = [&](const std::string& text) {
        base::write_atomically(folder_ / "a.ply", text);
        return read_mesh_file(folder_ / "a.ply");
    };
    auto file = read_ply(head + "property int texnumber\nend_header\n" + points +
                         "3 0 1 2 6 0 0 1 0 0 1 1\n3 0 1 2 6 0 0 1 0 0 1 0\n3 0 1 2 6 0 0 1 0 0 1 7\n");
    EXPECT_THAT(file.texture_files, ElementsAre("up.png", "low.png"));
    EXPECT_THAT(file.face_textures, ElementsAre(0U, 1U, no_picture));
    EXPECT_THAT(file.remarks,
                ElementsAre(HasSubstr(
                    "'texnumber' of 1 face is that of no image (there are 2), so there is no picture on it")));
    file = read_ply(head + "end_header\n" + points +
                    "3 0 1 2 6 0 0 1 0 0 1\n3 0 1 2 6 0 0 1 0 0 1\n3 0 1 2 6 0 0 1 0 0 1\n");
    EXPECT_EQ(file.texture_file, "low.png");
    EXPECT_THAT(file.remarks, ElementsAre(HasSubstr("names 2 images and no 'texnumber' says which face has which")));
}

TEST_F(MeshTextures, of_several_images_are_written_and_read_back) {
    auto mesh = read("", square("", "", "")).mesh;
    mesh.faces.add(std::array<std::uint32_t, 3>{1, 2, 3});
    for (const std::uint32_t k : {1U, 2U, 3U}) mesh.faces.texture_corners.push_back(k);
    if (mesh.faces.texture_corners.size() != mesh.faces.corners.size()) mesh.faces.texture_corners = mesh.faces.corners;
    MeshWriteOptions options;
    options.texture_files = {"one.png", "two.png"};
    options.face_textures = {1, no_picture, 0};
    for (const auto* name : {"out.obj", "out.ply", "text.ply"}) {
        options.binary = std::string_view(name) != "text.ply";
        write_mesh(folder_ / name, mesh, options);
        const auto file = read_mesh_file(folder_ / name);
        EXPECT_THAT(file.texture_files, ElementsAre("two.png", "one.png")) << name;
        EXPECT_THAT(file.face_textures, ElementsAre(0U, no_picture, 1U)) << name;
        EXPECT_EQ(file.mesh.faces.corners, mesh.faces.corners) << name;
    }
    options.face_textures = {2, 0, 0};
    EXPECT_THAT(message_of([&] { write_mesh(folder_ / "no.obj", mesh, options); }),
                HasSubstr("a face has image 2 of 2"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "no.mtl"));
}

TEST_F(MeshTextures, say_what_made_the_mesh) {
    auto mesh = read("", square("", "", "")).mesh;
    MeshWriteOptions options;
    options.made_by = {{"made_by", "Mimik 1"}, {"source", "bs\n003 <&>"}};
    for (const auto* name : {"out.obj", "out.ply", "out.vtp"}) {
        write_mesh(folder_ / name, mesh, options);
        EXPECT_EQ(read_mesh(folder_ / name).vertices_mm, mesh.vertices_mm) << name;
    }
    EXPECT_THAT(base::read_text(folder_ / "out.obj"), HasSubstr("\n# made_by: Mimik 1\n# source: bs 003 <&>\n"));
    EXPECT_THAT(base::read_text(folder_ / "out.ply"),
                HasSubstr("\ncomment made_by: Mimik 1\ncomment source: bs 003 <&>\n"));
    EXPECT_THAT(base::read_text(folder_ / "out.vtp"),
                HasSubstr("<Array type=\"String\" Name=\"made_by\" NumberOfComponents=\"1\" NumberOfTuples=\"1\" "
                          "format=\"ascii\">\n77 105 109 105 107 32 49 0\n</Array>"));
}

// ---- scans

TEST_F(MeshTextures, of_a_scan_that_lie_in_another_unit_square_are_moved_into_the_first) {
    const auto scan_of = [&](const std::string& positions) {
        base::write_atomically(folder_ / "s.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n" + positions + "f 1/1 2/2 3/3\n");
        return read_range_scan(folder_ / "s.obj");
    };
    auto scan = scan_of("vt 0 -1\nvt 1 -1\nvt 1 0\n");
    EXPECT_THAT(scan.texture_coordinates,
                ElementsAre(TextureCoordinate(0, 0), TextureCoordinate(1, 0), TextureCoordinate(1, 1)));
    EXPECT_FALSE(scan.charts);
    scan = scan_of("vt 3.25 7.5\nvt 3.5 7.5\nvt 3.5 7.75\n");
    EXPECT_EQ(scan.texture_coordinates[2], TextureCoordinate(0.5, 0.75));
    scan = scan_of("vt 0.5 0\nvt 2.5 0\nvt 0.5 1\n");  // the image repeats across the face
    ASSERT_TRUE(scan.charts);
    EXPECT_EQ(scan.charts->positions[1], TextureCoordinate(2.5, 0));
}

TEST_F(MeshTextures, of_a_scan_with_seams_or_several_images_are_kept_as_charts) {
    base::write_atomically(folder_ / "a.mtl", "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n");
    base::write_atomically(folder_ / "a.obj", square("mtllib a.mtl\n", "usemtl a\n", "usemtl b\n"));
    auto scan = read_range_scan(folder_ / "a.obj");
    ASSERT_TRUE(scan.charts);
    EXPECT_THAT(scan.charts->images, ElementsAre("a.png", "b.png"));
    EXPECT_THAT(scan.charts->image_of_face, ElementsAre(0U, 1U));
    EXPECT_EQ(scan.texture_file, "a.png");
    EXPECT_EQ(scan.texture_seam_points, 0U);
    // Points doubled along the seam, one position each, as PLY and VTP have it.
    geometry::Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.texture_coordinates = {{0, 0}, {0.4, 0}, {0.4, 1}, {0.6, 0}, {1, 1}, {0.6, 1}};
    mesh.faces.add(std::array<std::uint32_t, 3>{0, 1, 2});
    mesh.faces.add(std::array<std::uint32_t, 3>{3, 4, 5});
    write_mesh(folder_ / "doubled.ply", mesh, {.texture_file = "a.png"});
    scan = read_range_scan(folder_ / "doubled.ply");
    EXPECT_EQ(scan.texture_seam_points, 2U);
    EXPECT_TRUE(scan.charts);
    for (std::size_t k = 3; k < 5; ++k) mesh.texture_coordinates[k] = mesh.texture_coordinates[k == 3 ? 0 : 2];
    write_mesh(folder_ / "doubled.ply", mesh, {.texture_file = "a.png"});
    EXPECT_FALSE(read_range_scan(folder_ / "doubled.ply").charts);
}

// ---- one picture of several

TEST_F(MeshTextures, of_several_images_become_one_picture_in_which_each_face_keeps_its_colour) {
    auto file =
        read("newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n", square("mtllib a.mtl\n", "usemtl a\n", "usemtl b\n"));
    for (auto& uv : file.mesh.texture_coordinates) uv.y() -= 2;  // whole numbers make no difference
    const std::vector<std::optional<Image>> images = {Image{2, 2, {255, 0, 0, 255, 0, 0, 250, 0, 0, 250, 0, 0}},
                                                      Image{1, 1, {0, 0, 255}}};
    const auto picture = texture_atlas(file.mesh, images, file.face_textures);
    const auto& mesh = file.mesh;
    const auto colour = [&](std::size_t face, double a, double b) {
        TextureCoordinate uv = TextureCoordinate::Zero();
        const std::array<double, 3> weights = {1 - a - b, a, b};
        for (std::size_t k = 0; k < 3; ++k)
            uv += weights[k] * mesh.texture_coordinates[mesh.faces.texture_corners[3 * face + k]];
        const auto x = static_cast<std::size_t>(uv.x() * picture.width);
        const auto y = static_cast<std::size_t>((1 - uv.y()) * picture.height);
        const auto at = 3 * (y * static_cast<std::size_t>(picture.width) + x);
        return std::array<int, 3>{picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
    };
    EXPECT_THAT(colour(0, 0.3, 0.6), ElementsAre(255, 0, 0));  // the upper half
    EXPECT_THAT(colour(0, 0.6, 0.1), ElementsAre(250, 0, 0));
    EXPECT_THAT(colour(1, 0.3, 0.3), ElementsAre(0, 0, 255));
}

}  // namespace
}  // namespace mimik::io
