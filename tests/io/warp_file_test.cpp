#include "io/warp_file.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/file.h"
#include "geometry/landmark_spline.h"
#include "io/image.h"
#include "io/mesh_io.h"
#include "io/points_csv.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thrown.h"

namespace mimik::io {

using geometry::Landmark;
using geometry::Landmarks;
using geometry::Point;

namespace {

using test::message_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Warp : public testing::Test {
protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("mimik_warp_") + test->name() + "_" + std::to_string(::getpid()));
        std::filesystem::remove_all(folder_);
        // Corners of a box and its middle; the middle moves by 1 in x.
        base::write_atomically(
            folder_ / "a.csv",
            "name,x,y,z\nc0,0,0,0\nc1,4,0,0\nc2,0,4,0\nc3,0,0,4\nc4,4,4,0\nc5,4,0,4\nc6,0,4,4\nc7,4,4,4\nm,2,2,2\n");
        base::write_atomically(
            folder_ / "b.csv",
            "x,name,y,z\n3,m,2,2\n0,c0,0,0\n4,c1,0,0\n0,c2,4,0\n0,c3,0,4\n4,c4,4,0\n4,c5,0,4\n0,c6,4,4\n4,c7,4,4\n");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::filesystem::path at(const char* name) const { return folder_ / name; }

    std::filesystem::path folder_;
};

TEST_F(Warp, of_a_csv_keeps_names_and_order_and_writes_every_digit) {
    base::write_atomically(at("in.csv"), "name,x,y,z\nsecond,2,2,2\nfirst,0.1,0.2,0.3\nsecond,4,4,4\n");
    const auto report = warp_file(at("a.csv"), at("b.csv"), at("in.csv"), at("out.csv"));
    EXPECT_EQ(report.landmarks, 9U);
    EXPECT_EQ(report.points, 3U);
    EXPECT_NEAR(report.largest_displacement, 1.0, 1e-12);  // the middle; rounding of coordinates below 10
    EXPECT_LT(report.largest_landmark_residual, 1e-12);
    const auto out = read_points_csv(at("out.csv"));
    EXPECT_THAT(out.names, ElementsAre("second", "first", "second"));
    EXPECT_LT((out.points[0] - Point(3, 2, 2)).norm(), 1e-12);
    const Landmarks a({{"c0", {0, 0, 0}, ""},
                       {"c1", {4, 0, 0}, ""},
                       {"c2", {0, 4, 0}, ""},
                       {"c3", {0, 0, 4}, ""},
                       {"c4", {4, 4, 0}, ""},
                       {"c5", {4, 0, 4}, ""},
                       {"c6", {0, 4, 4}, ""},
                       {"c7", {4, 4, 4}, ""},
                       {"m", {2, 2, 2}, ""}});
    std::vector<Landmark> moved(a.all().begin(), a.all().end());
    moved[8].position_mm.x() = 3;
    // To the last bit: 17 digits lose nothing.
    EXPECT_EQ(out.points[1], geometry::landmark_spline(a, Landmarks(moved))(Point(0.1, 0.2, 0.3)));
}

TEST_F(Warp, of_a_mesh_keeps_faces_and_texture_coordinates) {
    base::write_atomically(
        at("in.obj"),
        "v 2 2 2\nv 4 0 0\nv 4 4 4\nv 0 4 4\nvt 0.25 0.5\nvt 0.75 1\nvt 0 0\nvt 1 0\nf 1/1 2/2 3/3 4/4\n");
    for (const char* name : {"sub/out.obj", "out.ply", "out.vtp"}) {
        (void)warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at(name));
        const auto mesh = read_mesh(at(name));
        ASSERT_EQ(mesh.vertices_mm.size(), 4U) << name;
        EXPECT_LT((mesh.vertices_mm[0] - Point(3, 2, 2)).norm(), 1e-12) << name;
        EXPECT_LT((mesh.vertices_mm[3] - Point(0, 4, 4)).norm(), 1e-12) << name;
        ASSERT_EQ(mesh.faces.size(), 1U) << name;
        EXPECT_THAT(std::vector(mesh.faces[0].begin(), mesh.faces[0].end()), ElementsAre(0U, 1U, 2U, 3U)) << name;
        ASSERT_EQ(mesh.texture_coordinates.size(), 4U) << name;
        EXPECT_NEAR(mesh.texture_coordinates[1].x(), 0.75, 1e-6) << name;  // single precision in some formats
    }
    (void)warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("out.csv"));
    EXPECT_THAT(read_points_csv(at("out.csv")).names, ElementsAre("0", "1", "2", "3"));
    (void)warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("out.stl"));
    EXPECT_EQ(read_mesh(at("out.stl")).faces.size(), 2U);
}

TEST_F(Warp, takes_the_texture_image_along_under_a_name_that_no_other_image_has) {
    base::write_atomically(
        at("in.obj"), "mtllib in.mtl\nv 2 2 2\nv 4 0 0\nv 4 4 4\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl skin\nf 1/1 2/2 3/3\n");
    base::write_atomically(at("in.mtl"), "newmtl skin\nmap_Kd tex/skin.png\n");
    write_png(at("tex/skin.png"), {1, 1, {200, 120, 90}});
    base::write_atomically(at("elsewhere/skin.png"), "somebody else's");
    for (const auto* name : {"elsewhere/out.obj", "elsewhere/out.ply"}) {
        (void)warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at(name));
        EXPECT_EQ(read_mesh_file(at(name)).texture_file, "out_texture.png") << name;
    }
    EXPECT_EQ(base::read_text(at("elsewhere/out_texture.png")), base::read_text(at("tex/skin.png")));
    EXPECT_EQ(base::read_text(at("elsewhere/skin.png")), "somebody else's");
    const auto nobody = [](const std::filesystem::path& image) { throw InputError(image.filename().string()); };
    EXPECT_EQ(message_of([&] { (void)warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("no.obj"), {}, nobody); }),
              "skin.png");
    EXPECT_FALSE(std::filesystem::exists(at("no.obj")) || std::filesystem::exists(at("no_texture.png")));
    std::filesystem::remove(at("tex/skin.png"));
    (void)warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("bare.obj"));
    EXPECT_EQ(read_mesh_file(at("bare.obj")).texture_file, "");
}

TEST_F(Warp, leaves_out_a_texture_that_it_cannot_find_and_says_so) {
    base::write_atomically(at("in.obj"), "mtllib in.mtl\nv 2 2 2\nv 4 0 0\nv 4 4 4\nf 1 2 3\n");
    base::write_atomically(at("in.mtl"), "newmtl skin\nmap_Kd C:\\scans\\face.jpg\n");
    for (const char* name : {"out.obj", "out.ply"}) {
        const auto report = warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at(name));
        EXPECT_EQ(report.points, 3U) << name;
        EXPECT_THAT(report.remarks, ElementsAre(HasSubstr("texture name is 'C:"))) << name;
    }
    base::write_atomically(at("in.mtl"), "newmtl skin\nmap_Kd face.jpg\n");
    EXPECT_THAT(warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("out.ply")).remarks,
                ElementsAre(HasSubstr("texture 'face.jpg' is left out: it is not beside the mesh")));
    EXPECT_THAT(warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("out.stl")).remarks,
                ElementsAre(HasSubstr("out.stl: the format names no image")));
}

TEST_F(Warp, hands_on_nothing_but_images_that_lie_with_the_mesh) {
    base::write_atomically(at("in.obj"), "mtllib in.mtl\nv 2 2 2\nv 4 0 0\nv 4 4 4\nf 1 2 3\n");
    base::write_atomically(at("in.mtl"), "newmtl skin\nmap_Kd skin.png\n");
    const auto remark_of = [&] {
        std::filesystem::remove(at("out_texture.png"));
        const auto report = warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("out.ply"));
        EXPECT_EQ(read_mesh_file(at("out.ply")).texture_file,
                  std::filesystem::exists(at("out_texture.png")) ? "out_texture.png" : "");
        return report.remarks.empty() ? std::string() : report.remarks.front();
    };
    base::write_atomically(at("skin.png"), "-----BEGIN KEY-----\n");
    EXPECT_THAT(remark_of(), HasSubstr("skin.png: is neither a PNG, a JPEG nor a BMP image"));
    base::write_atomically(at("skin.png"), "\x89PNG\r\n\x1A\n and no more");
    EXPECT_THAT(remark_of(), HasSubstr("skin.png"));
    const test::TemporaryFolder elsewhere;
    write_png(elsewhere.path() / "private.png", {1, 1, {1, 2, 3}});
    std::filesystem::remove(at("skin.png"));
    std::filesystem::create_symlink(elsewhere.path() / "private.png", at("skin.png"));
    EXPECT_THAT(remark_of(), HasSubstr("a link that leads out of the mesh's folder"));
    EXPECT_FALSE(std::filesystem::exists(at("out_texture.png")));
    std::filesystem::remove(at("skin.png"));
    write_png(at("sub/true.png"), {1, 1, {1, 2, 3}});
    std::filesystem::create_symlink("sub/true.png", at("skin.png"));
    EXPECT_EQ(remark_of(), "");
    EXPECT_TRUE(std::filesystem::exists(at("out_texture.png")));
}

TEST_F(Warp, takes_several_images_along) {
    base::write_atomically(at("in.obj"),
                           "mtllib in.mtl\nv 2 2 2\nv 4 0 0\nv 4 4 4\nv 0 4 4\nvt 0 0\nvt 1 0\nvt 1 1\n"
                           "usemtl b\nf 1/1 2/2 3/3\nusemtl a\nf 1/1 3/2 4/3\nusemtl lost\nf 2/1 3/2 4/3\n");
    base::write_atomically(at("in.mtl"),
                           "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\nnewmtl lost\nmap_Kd lost.png\n");
    write_png(at("a.png"), {1, 1, {255, 0, 0}});
    write_png(at("b.png"), {1, 1, {0, 0, 255}});
    for (const char* name : {"out/x.obj", "out/x.ply"}) {
        const auto report = warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at(name));
        EXPECT_THAT(report.remarks, ElementsAre(HasSubstr("texture 'lost.png' is left out"))) << name;
        const auto file = read_mesh_file(at(name));
        EXPECT_THAT(file.texture_files, ElementsAre("x_texture.png", "x_texture_2.png")) << name;
        EXPECT_THAT(file.face_textures, ElementsAre(0U, 1U, no_picture)) << name;
    }
    EXPECT_EQ(read_png(at("out/x_texture.png")).rgb, (std::vector<std::uint8_t>{0, 0, 255}));
    EXPECT_EQ(read_png(at("out/x_texture_2.png")).rgb, (std::vector<std::uint8_t>{255, 0, 0}));
}

TEST_F(Warp, goes_without_an_image_that_the_system_will_not_look_for) {
    base::write_atomically(at("in.obj"), "mtllib in.mtl\nv 2 2 2\nv 4 0 0\nv 4 4 4\nf 1 2 3\n");
    base::write_atomically(at("in.mtl"), "newmtl skin\nmap_Kd loop.png\n");
    std::filesystem::create_symlink("loop.png", at("loop.png"));
    (void)warp_file(at("a.csv"), at("b.csv"), at("in.obj"), at("out.obj"));
    EXPECT_EQ(read_mesh_file(at("out.obj")).texture_file, "");
}

TEST_F(Warp, of_a_point_whose_place_has_no_number_is_refused_by_its_name) {
    base::write_atomically(at("in.csv"), "name,x,y,z\nnear,2,2,2\nfar,1e200,0,0\n");
    EXPECT_THAT(
        message_of<NumericalError>([&] { (void)warp_file(at("a.csv"), at("b.csv"), at("in.csv"), at("out.csv")); }),
        AllOf(HasSubstr("in.csv"), HasSubstr("'far' at (1e+200, 0, 0)")));
    EXPECT_FALSE(std::filesystem::exists(at("out.csv")));
}

TEST_F(Warp, every_name_without_a_partner_is_listed) {
    base::write_atomically(at("c.csv"), "name,x,y,z\nc0,0,0,0\nc1,4,0,0\nc2,0,4,0\nnew1,0,0,4\nnew2,1,1,1\n");
    base::write_atomically(at("in.csv"), "name,x,y,z\np,2,2,2\n");
    EXPECT_THAT(
        message_of<InputError>([&] { (void)warp_file(at("a.csv"), at("c.csv"), at("in.csv"), at("out.csv")); }),
        AllOf(HasSubstr("'c3', 'c4', 'c5', 'c6', 'c7', 'm'"), HasSubstr("'new1', 'new2'"), Not(HasSubstr("c2"))));
    EXPECT_FALSE(std::filesystem::exists(at("out.csv")));
}

TEST_F(Warp, works_in_any_unit_as_coordinates_are_given) {
    for (const double unit : {1e-6, 1e6}) {
        std::vector<Landmark> from, to;
        for (int i = 0; i < 8; ++i) {
            const Point p = unit * Point(i & 1, (i >> 1) & 1, (i >> 2) & 1);
            from.push_back({std::to_string(i), p, ""});
            to.push_back({std::to_string(i), 2 * p, ""});
        }
        const auto spline = geometry::landmark_spline(Landmarks(from), Landmarks(to));
        EXPECT_LT((spline(unit * Point(3, 4, 5)) - unit * Point(6, 8, 10)).norm(), 1e-12 * unit);
    }
}

TEST_F(Warp, coplanar_landmarks_and_formats_that_cannot_be_written_are_refused) {
    base::write_atomically(at("flat.csv"), "name,x,y,z\na,0,0,0\nb,4,0,0\nc,0,4,0\nd,4,4,0\ne,1,3,0\n");
    base::write_atomically(at("in.csv"), "name,x,y,z\np,2,2,2\n");
    EXPECT_THAT(message_of<NumericalError>(
                    [&] { (void)warp_file(at("flat.csv"), at("flat.csv"), at("in.csv"), at("out.csv")); }),
                AllOf(HasSubstr("one plane"), HasSubstr("'a', 'b', 'c', 'd', 'e'")));
    EXPECT_THAT(message_of<InputError>([&] { (void)warp_file(at("a.csv"), at("b.csv"), at("in.csv"), at("out.pcd")); }),
                HasSubstr("out.pcd"));
    EXPECT_THAT(message_of<InputError>([&] { (void)warp_file(at("a.csv"), at("b.csv"), at("in.csv"), at("out.xyz")); }),
                HasSubstr("out.xyz"));
}

TEST(ThinPlateSplineOptions, defaults_are_valid_and_bad_values_are_refused_by_field) {
    EXPECT_NO_THROW(geometry::ThinPlateSplineOptions{}.check());
    EXPECT_THAT(message_of<InputError>([] { geometry::ThinPlateSplineOptions{.smoothing = -1}.check(); }),
                HasSubstr("smoothing is -1"));
    EXPECT_THAT(message_of<InputError>([] { geometry::ThinPlateSplineOptions{.min_separation_ratio = 1}.check(); }),
                HasSubstr("min_separation_ratio is 1"));
    EXPECT_THAT(message_of<InputError>([] { geometry::ThinPlateSplineOptions{.min_thickness_ratio = -1}.check(); }),
                HasSubstr("min_thickness_ratio is -1"));
}

}  // namespace
}  // namespace mimik::io
