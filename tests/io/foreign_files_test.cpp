// Files as other programs write them: tests/data/foreign/README.md says what each has.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "geometry/polygon_triangles.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "io/points_csv.h"
#include "io/warp_file.h"
#include "tests/io/files_testing.h"

namespace mimik::io {
namespace {

using geometry::Mesh;
using geometry::Point;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace fs = std::filesystem;

const fs::path data = MIMIK_FOREIGN_FILES;
const Point moved(1, 2, 3);

constexpr double single_precision = 1e-5;  // coordinates of 60 in 32 bits, and the spline's rounding

/// The largest distance between vertices of the same number.
double largest_distance(const std::vector<Point>& a, const std::vector<Point>& b, const Point& shift) {
    double largest = a.size() == b.size() ? 0 : INFINITY;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = std::max(largest, (a[i] + shift - b[i]).norm());
    return largest;
}

WarpReport warp(const fs::path& input, const fs::path& output, const fs::path& from = data / "from.csv",
                const fs::path& to = data / "to.csv", const WarpFileOptions& more = {}) {
    return warp_file(from, to, input, output, {}, {}, more);
}

std::string all_of(const std::vector<std::string>& remarks) { return fmt::format("{}", fmt::join(remarks, "\n")); }

class ForeignMesh : public testing::TestWithParam<const char*> {};

TEST_P(ForeignMesh, is_moved_by_1_2_3_with_its_32_triangles) {
    const TemporaryFolder folder;
    (void)warp(data / GetParam(), folder / "out.ply");
    const auto out = read_mesh(folder / "out.ply");
    EXPECT_EQ(triangulate(out.faces, out.vertices_mm).size(), 32U);
    EXPECT_LT(largest_distance(read_mesh(data / "ref.ply").vertices_mm, out.vertices_mm, moved), single_precision);
}

INSTANTIATE_TEST_SUITE_P(OfTheCases, ForeignMesh,
                         testing::Values("obj-bad-faces/two.obj", "obj-mixed-colours/a.obj", "obj-nan-texture/a.obj",
                                         "obj-no-vt-lines/a.obj", "ply-cr-header/a.ply", "ply-cr-header/b.ply",
                                         "ply-nan-normals/n4.ply", "ply-nan-normals/n5.ply", "ply-part-textured/a.ply",
                                         "ply-tristrips/strips.ply", "vtp-array-names/blank.vtp",
                                         "vtp-array-names/plain.vtp", "vtp-array-names/short.vtp",
                                         "vtp-array-names/unnamed.vtp"));

TEST(ForeignStl, spellings_and_ends_of_all_kinds_are_the_same_surface) {
    const auto reference = read_mesh(data / "ref.ply");
    for (const char* name :
         {"stl-ascii-words/endloop.stl", "stl-ascii-words/comment.stl", "stl-ascii-words/oneline.stl",
          "stl-trailing-bytes/newline.stl", "stl-trailing-bytes/payload.stl", "stl-trailing-bytes/tail.stl"}) {
        const auto mesh = read_mesh(data / name);
        EXPECT_EQ(mesh.faces.size(), 32U) << name;
        ASSERT_EQ(mesh.vertices_mm.size(), 25U) << name;
        for (const auto& p : reference.vertices_mm)  // in another order
            EXPECT_TRUE(std::any_of(mesh.vertices_mm.begin(), mesh.vertices_mm.end(), [&](const Point& q) {
                return (p - q).norm() < single_precision;
            })) << name;
    }
}

Mesh stl(const std::string& text) { return decode_mesh(MeshFormat::stl, bytes_of(text), "s").mesh; }

TEST(ForeignStl, ascii_is_read_word_by_word) {
    const std::string facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet";
    const std::string other =
        "facet normal nan -nan(ind) 1.#QNAN\nouter loop\nvertex 0 0 1\nvertex 1 0 1\nvertex 0 1 1\n"
        "end loop\nend facet\n";
    EXPECT_EQ(
        stl("SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\n"
            "ENDSOLID\n")
            .faces.size(),
        1U);
    EXPECT_EQ(stl("solid\n" + other + "endsolid\n").faces.size(), 1U);
    EXPECT_EQ(stl("solid a " + facet + " endsolid a solid b " + facet + " endsolid b").faces.size(), 2U);
    EXPECT_EQ(stl("solid one\n" + other + "endsolid one\nsolid two\n" + other + "end solid two\n").faces.size(), 2U);
    EXPECT_EQ(stl("solid my facet normal holder\n" + other + "endsolid my solid\n").faces.size(), 1U);
    EXPECT_EQ(stl("; made by hand\n# twice\nsolid a\n// facet\n" + other + "endsolid\n").faces.size(), 1U);
    EXPECT_EQ(
        stl("solid a\rfacet normal 0 0 1\router loop\rvertex 0 0 0\rvertex 1 0 0\rvertex 0 1 0\rendloop\rendfacet\r"
            "endsolid a\r")
            .faces.size(),
        1U);
    EXPECT_EQ(stl("solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid")
                  .faces.size(),
              1U);
}

TEST(ForeignPly, colours_of_any_type_are_those_of_bytes) {
    for (const char* name : {"ply-float-colours/reals_255.ply", "ply-float-colours/ushorts.ply"}) {
        const auto mesh = read_mesh(data / name);
        ASSERT_EQ(mesh.colours.size(), 25U) << name;
        for (std::size_t i = 0; i < 25; ++i)
            EXPECT_THAT(mesh.colours[i], ElementsAre(10 * i, 255 - 10 * i, 128)) << name << ' ' << i;
    }
}

TEST(ForeignPly, strips_are_the_triangles_that_they_stand_for) {
    const auto strips = read_mesh(data / "ply-tristrips/strips.ply"), faces = read_mesh(data / "ref.ply");
    double up = 0;
    for (const auto& t : triangulate(strips.faces, strips.vertices_mm))
        up += (strips.vertices_mm[t[1]] - strips.vertices_mm[t[0]])
                  .cross(strips.vertices_mm[t[2]] - strips.vertices_mm[t[0]])
                  .z();
    EXPECT_NEAR(up, 2.0 * 120 * 120, 1e-6);  // each turns the same way, and together they cover the square once
    EXPECT_EQ(strips.vertices_mm, faces.vertices_mm);
}

TEST(ForeignPly, what_is_left_out_is_counted) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nelement face 3\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n"
        "0 0 0 1.#QNAN\n1 0 0 garbage\n1 1 0 nan\n0 1 0 -1.#IND\n";
    const auto file = decode_mesh(
        MeshFormat::ply, bytes_of(head + "4 0 1 2 3 8 0 0 1 0 1 1 0 1\n2 0 1 4 0 0 1 1\n3 0 1 2 0\nmore\n"), "p");
    EXPECT_EQ(file.mesh.faces.size(), 2U);
    EXPECT_THAT(file.remarks,
                ElementsAre(HasSubstr("p: 1 face has no texture position for each corner; it gets (0, 0)"),
                            HasSubstr("p: 1 face has fewer than 3 corners; it is left out"),
                            HasSubstr("p: 4 bytes behind the last")));
    EXPECT_EQ(file.mesh.faces.texture_corners.size(), 7U);
    EXPECT_EQ(file.mesh.texture_coordinates.size(), 5U);
}

// Scanners and modelling programs leave them behind: the surface does not need them.
TEST(ForeignMeshes, a_vertex_without_a_position_that_no_face_uses_is_left_out_with_all_that_belongs_to_it) {
    const auto ply = decode_mesh(
        MeshFormat::ply,
        bytes_of("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                 "property float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                 "property float quality\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "nan nan nan 0 0 1 1 1 10\n0 0 0 .1 0 2 2 2 20\n1 0 0 .2 0 3 3 3 30\n1.#QNAN 0 0 .3 0 4 4 4 40\n"
                 "1 1 0 .4 0 5 5 5 50\n3 1 2 4\n"),
        "p");
    ASSERT_EQ(ply.mesh.vertices_mm.size(), 3U);
    EXPECT_EQ(ply.mesh.vertices_mm[2], Point(1, 1, 0));
    EXPECT_THAT(ply.mesh.faces.corners, ElementsAre(0, 1, 2));
    EXPECT_NEAR(ply.mesh.texture_coordinates.at(2).x(), 0.4, 1e-7);
    EXPECT_THAT(ply.mesh.colours.at(1), ElementsAre(3, 3, 3));
    EXPECT_THAT(ply.mesh.attributes.at(0).values, ElementsAre(20, 30, 50));
    EXPECT_THAT(ply.remarks, ElementsAre("p: 2 points that were not measured (NaN) are left out"));

    // Texture positions of an OBJ belong to corners, and stay.
    const auto obj = decode_mesh(
        MeshFormat::obj, bytes_of("v 0 0 0\nv nan nan nan\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nf 1/1 3/2 4/2\n"), "o");
    ASSERT_EQ(obj.mesh.vertices_mm.size(), 3U);
    EXPECT_THAT(obj.mesh.faces.corners, ElementsAre(0, 1, 2));
    EXPECT_THAT(obj.mesh.faces.texture_corners, ElementsAre(0, 1, 1));
    EXPECT_THAT(obj.remarks, ElementsAre("o: 1 point that was not measured (NaN) is left out"));
}

TEST(ForeignMeshes, a_cloud_loses_the_points_that_were_not_measured) {
    const auto cloud = decode_mesh(MeshFormat::obj, bytes_of("v 0 0 0\nv inf 0 0\nv 1 1 0\n"), "o");
    EXPECT_EQ(cloud.mesh.vertices_mm.size(), 2U);
    EXPECT_THAT(cloud.remarks, ElementsAre("o: 1 point that was not measured (NaN) is left out"));
}

TEST(ForeignObj, what_is_left_out_is_counted) {
    const auto file = decode_mesh(
        MeshFormat::obj,
        bytes_of("v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nvt 0 nan\nvt 1.#QNAN 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1 2\nf\nf 1 2 3\n"),
        "o");
    EXPECT_EQ(file.mesh.faces.size(), 2U);
    EXPECT_THAT(all_of(file.remarks), testing::AllOf(HasSubstr("o: 2 vertices have no colour"),
                                                     HasSubstr("o: 3 corners of faces have no texture"),
                                                     HasSubstr("o: 2 faces have fewer than 3 corners"),
                                                     HasSubstr("o: 2 texture positions are not finite")));
    EXPECT_THAT(file.mesh.colours[1], ElementsAre(255, 255, 255));
}

TEST(ForeignObj, a_face_that_is_left_out_takes_its_texture_along) {
    const auto file =
        decode_mesh(MeshFormat::obj, bytes_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/2\nf 1 2 3\n"), "o");
    EXPECT_EQ(file.mesh.faces.size(), 1U);
    EXPECT_THAT(file.mesh.texture_coordinates, IsEmpty());
    EXPECT_THAT(file.mesh.faces.texture_corners, IsEmpty());
}

TEST(ForeignNames, are_mended_where_a_format_cannot_hold_them) {
    const TemporaryFolder folder;
    EXPECT_THAT(all_of(warp(data / "vtp-array-names/blank.vtp", folder / "out.ply").remarks),
                HasSubstr("'Signed Distance' is called 'Signed_Distance'"));
    EXPECT_EQ(read_mesh(folder / "out.ply").attributes.at(0).name, "Signed_Distance");
    EXPECT_THAT(all_of(warp(data / "vtp-array-names/short.vtp", folder / "out.ply").remarks),
                HasSubstr("'s' is called 's_2'"));
    EXPECT_THAT(read_mesh(folder / "out.ply").texture_coordinates, IsEmpty());
    EXPECT_THAT(all_of(warp(data / "vtp-array-names/unnamed.vtp", folder / "out.vtp").remarks),
                HasSubstr("has no name; it is called 'unnamed'"));
    EXPECT_THAT(all_of(warp(data / "vtp-array-names/plain.vtp", folder / "out.obj").remarks),
                HasSubstr("no place for"));
}

TEST(ForeignPcd, unmeasured_points_and_lines_of_ones_own_are_passed_over) {
    const TemporaryFolder folder;
    EXPECT_EQ(warp(data / "pcd-mixed-fields/custom.pcd", folder / "out.csv").points, 25U);
    EXPECT_LT(
        largest_distance(read_mesh(data / "ref.ply").vertices_mm, read_points_csv(folder / "out.csv").points, moved),
        single_precision);
    const auto report = warp(data / "pcd-organised-nan/a.pcd", folder / "out.csv");
    EXPECT_EQ(report.points, 22U);
    EXPECT_THAT(all_of(report.remarks), HasSubstr("3 points that were not measured"));
    const auto pcd =
        decode_mesh(MeshFormat::pcd,
                    bytes_of("# .PCD v0.7\nSIZE 2 8 1 4 1 1 1\nTYPE I F U F U U U\nCOUNT 1 1 1 1 1 1 1\nNOTE my own\n"
                             "FIELDS z x label y r g b\nWIDTH 2\nHEIGHT 1\nDATA ASCII\n3 1 7 2 255 128 0\n"
                             "6 4 8 -nan(ind) 1 2 3\n"),
                    "p");
    EXPECT_EQ(pcd.mesh.vertices_mm[0], Point(1, 2, 3));
    EXPECT_FALSE(pcd.mesh.vertices_mm[1].allFinite());
    EXPECT_THAT(pcd.mesh.colours.at(0), ElementsAre(255, 128, 0));
}

TEST(ForeignTables, of_spreadsheets_are_read) {
    const TemporaryFolder folder;
    for (const char* kind : {"german", "padded", "utf16"}) {
        const auto file = [&](const char* side) { return data / "csv-excel" / fmt::format("{}_{}.csv", side, kind); };
        (void)warp(data / "ref.ply", folder / "out.ply", file("from"), file("to"));
        EXPECT_LT(
            largest_distance(read_mesh(data / "ref.ply").vertices_mm, read_mesh(folder / "out.ply").vertices_mm, moved),
            1e-4)  // four digits
            << kind;
    }
    EXPECT_THAT(message_of([&] {
                    (void)warp(data / "ref.ply", folder / "no.ply", data / "csv-no-header/from.csv", data / "to.csv");
                }),
                HasSubstr("from.csv: line 1: the header line is missing"));
}

TEST(ForeignFrames, of_slicer_files_are_honoured) {
    const TemporaryFolder folder;
    const auto frames = data / "fcsv-two-frames", slicer = data / "warp-slicer-frames";
    const auto report = warp(data / "ref.ply", folder / "out.ply", frames / "ras_old.fcsv", frames / "lps_new.fcsv");
    EXPECT_LT(report.largest_displacement, 1e-9);
    EXPECT_THAT(all_of(report.remarks), HasSubstr("ras_old.fcsv: says that it is in RAS; x and y are negated"));

    (void)warp(slicer / "mesh.ply", folder / "right.ply", data / "from.csv", slicer / "to.csv");
    const auto right = read_mesh(folder / "right.ply").vertices_mm;
    for (const char* from : {"from_ras.fcsv", "from_lps.fcsv", "from_ras.mrk.json"})
        for (const char* to : {"to_ras.fcsv", "to_lps.fcsv", "to_lps.mrk.json"}) {
            (void)warp(slicer / "mesh.ply", folder / "out.ply", slicer / from, slicer / to);
            EXPECT_LT(largest_distance(right, read_mesh(folder / "out.ply").vertices_mm, Point::Zero()), 1e-6)
                << from << ' ' << to;  // nine digits in the files
        }
    EXPECT_LT(warp(data / "ref.ply", folder / "out.ply", data / "fcsv-slicer3/from.fcsv", data / "fcsv-slicer3/to.fcsv")
                  .largest_displacement,
              moved.norm() + single_precision);
    EXPECT_LT(
        largest_distance(read_mesh(data / "ref.ply").vertices_mm, read_mesh(folder / "out.ply").vertices_mm, moved),
        single_precision);
}

/// A slope that no half turn about z brings onto itself, and marks on it and where they go: in the mesh's own numbers.
class StatedFrames : public testing::Test {
protected:
    void SetUp() override {
        for (int i = 0; i < 5; ++i)
            for (int j = 0; j < 5; ++j) mesh_.vertices_mm.emplace_back(20 + 10 * i, 30 + 10 * j, i * i + j);
        for (std::uint32_t i = 0; i < 4; ++i)
            for (std::uint32_t j = 0; j < 4; ++j)
                mesh_.faces.add(std::array{5 * i + j, 5 * i + j + 5, 5 * i + j + 6, 5 * i + j + 1});
        std::vector<geometry::Landmark> from, to;
        for (std::size_t k = 0; k < 25; k += 3) {
            const Point p = mesh_.vertices_mm[k];
            from.push_back({fmt::format("m{}", k), p, ""});
            to.push_back({fmt::format("m{}", k), Point(1.1 * p.x() + 1, p.y() + 2, p.z() + 3), ""});
        }
        from_ = geometry::Landmarks(from);
        to_ = geometry::Landmarks(to);
    }
    void write_marks(const geometry::Landmarks& marks, const char* name, BodyFrame numbers, BodyFrame stated) const {
        auto text =
            encode_landmarks(LandmarkFormat::fcsv, in(marks, numbers == stated ? BodyFrame::lps : BodyFrame::ras));
        text.replace(text.find("= LPS"), 5, fmt::format("= {}", to_string(stated)));
        base::write_atomically(folder_ / name, text);
    }
    static geometry::Landmarks in(const geometry::Landmarks& marks, BodyFrame frame) {
        std::vector<geometry::Landmark> all(marks.all().begin(), marks.all().end());
        if (frame == BodyFrame::ras)
            for (auto& mark : all) negate_x_and_y({&mark.position_mm, 1});
        return geometry::Landmarks(all);
    }
    [[nodiscard]] std::vector<Point> right() const {
        write_landmarks(folder_ / "from.csv", from_);
        write_landmarks(folder_ / "to.csv", to_);
        write_mesh(folder_ / "plain.ply", mesh_);
        (void)warp(folder_ / "plain.ply", folder_ / "right.ply", folder_ / "from.csv", folder_ / "to.csv");
        return read_mesh(folder_ / "right.ply").vertices_mm;
    }

    const TemporaryFolder folder_;
    Mesh mesh_;
    geometry::Landmarks from_, to_;
};

TEST_F(StatedFrames, of_mesh_and_marks_meet_in_that_of_the_mesh_which_the_output_states) {
    const auto expected = right();
    for (const char* format : {"ply", "obj", "vtp", "stl"})
        for (const auto mesh_frame : {BodyFrame::lps, BodyFrame::ras})
            for (const auto marks_frame : {BodyFrame::lps, BodyFrame::ras}) {
                const auto in_file = folder_ / fmt::format("in.{}", format),
                           out_file = folder_ / fmt::format("out.{}", format);
                MeshWriteOptions options;
                options.frame = mesh_frame;
                write_mesh(in_file, mesh_, options);
                write_marks(from_, "from.fcsv", mesh_frame, marks_frame);
                write_marks(to_, "to.fcsv", mesh_frame, mesh_frame);
                (void)warp(in_file, out_file, folder_ / "from.fcsv", folder_ / "to.fcsv");
                const auto out = read_mesh_file(out_file);
                EXPECT_EQ(out.frame, mesh_frame) << format;
                if (std::string(format) != "stl") {  // welded in another order
                    EXPECT_LT(largest_distance(expected, out.mesh.vertices_mm, Point::Zero()), 1e-9) << format;
                }
                // Marks without a stated frame are in the mesh's own numbers.
                (void)warp(in_file, out_file, folder_ / "from.csv", folder_ / "to.fcsv");
                EXPECT_LT((read_mesh_file(out_file).mesh.vertices_mm[0] - out.mesh.vertices_mm[0]).norm(), 1e-9);
            }
}

TEST_F(StatedFrames, of_marks_alone_are_read_by_where_they_lie_and_an_option_decides) {
    const auto expected = right();
    // As Slicer 4.10 left them: both in RAS, and the mesh does not say so.
    write_marks(from_, "from.fcsv", BodyFrame::ras, BodyFrame::ras);
    write_marks(to_, "to.fcsv", BodyFrame::ras, BodyFrame::ras);
    const auto result = [&](const WarpFileOptions& more = {}) {
        (void)warp(folder_ / "plain.ply", folder_ / "out.ply", folder_ / "from.fcsv", folder_ / "to.fcsv", more);
        return largest_distance(expected, read_mesh(folder_ / "out.ply").vertices_mm, Point::Zero());
    };
    EXPECT_LT(result(), 1e-9);
    EXPECT_LT(result({.input_frame = BodyFrame::ras}), 1e-9);
    EXPECT_GT(result({.input_frame = BodyFrame::lps}), 1.0);
    write_marks(from_, "from.fcsv", BodyFrame::ras, BodyFrame::lps);
    EXPECT_LT(result(), 1e-9);
    // Marks that say nothing beside some that do: by each other.
    (void)warp(folder_ / "plain.ply", folder_ / "out.ply", folder_ / "from.csv", folder_ / "to.fcsv");
    EXPECT_LT(largest_distance(expected, read_mesh(folder_ / "out.ply").vertices_mm, Point::Zero()), 1e-9);
    MeshWriteOptions options;
    options.frame = BodyFrame::lps;
    write_mesh(folder_ / "plain.ply", mesh_, options);
    EXPECT_THAT(message_of([&] { (void)result({.input_frame = BodyFrame::ras}); }),
                HasSubstr("says that it is in LPS, not RAS"));
}

TEST_F(StatedFrames, of_tables_count_too) {
    const auto expected = right();
    std::string from = "label,r,a,s,defined,selected,visible,locked,description\n", to = "label\tl\tp\ts\tdefined\n";
    for (const auto& mark : from_.all())
        from += fmt::format("{},{:.17g},{:.17g},{:.17g},1,1,1,0,\n", mark.name, -mark.position_mm.x(),
                            -mark.position_mm.y(), mark.position_mm.z());
    for (const auto& mark : to_.all())
        to += fmt::format("{}\t{:.17g}\t{:.17g}\t{:.17g}\t1\n", mark.name, mark.position_mm.x(), mark.position_mm.y(),
                          mark.position_mm.z());
    base::write_atomically(folder_ / "from_table.csv", from + "later,,,,0,1,1,0,\n");
    base::write_atomically(folder_ / "to_table.tsv", to);
    const auto report =
        warp(folder_ / "plain.ply", folder_ / "out.ply", folder_ / "from_table.csv", folder_ / "to_table.tsv");
    EXPECT_LT(largest_distance(expected, read_mesh(folder_ / "out.ply").vertices_mm, Point::Zero()), 1e-9);
    EXPECT_THAT(all_of(report.remarks), HasSubstr("1 point without a position is left out"));
}

TEST(BodyFrames, are_found_in_comments) {
    EXPECT_EQ(frame_in_comment("3D Slicer output. SPACE=LPS", "m"), BodyFrame::lps);
    EXPECT_EQ(frame_in_comment("SPACE = RAS;UNIT=mm", "m"), BodyFrame::ras);
    EXPECT_EQ(frame_in_comment("space=right-anterior-superior", "m"), BodyFrame::ras);
    EXPECT_EQ(frame_in_comment("COLORSPACE=RAS", "m"), std::nullopt);
    EXPECT_EQ(frame_in_comment("space=world", "m"), std::nullopt);
    EXPECT_THAT(message_of([] { (void)frame_in_comment("SPACE=LAS", "m"); }),
                HasSubstr("m: SPACE is 'las'; it must be LPS"));
}

TEST(ForeignLandmarks, of_menpo_are_read_in_all_its_versions) {
    const auto read = [](const char* text) { return decode_landmarks(LandmarkFormat::ljson, text, "l"); };
    const auto v1 = read(R"({"groups": [{"label": "chin", "connectivity": [], "landmarks": [{"point": [1, 2, 3]}]},
        {"label": "eye", "landmarks": [{"point": [4, 5, 6]}, {"point": [null, null, null]}, {"point": [7, 8, 9]}]}], "version": 1})");
    ASSERT_EQ(v1.size(), 3U);
    EXPECT_EQ(v1.at("chin").position_mm, Point(1, 2, 3));
    EXPECT_EQ(v1.at("eye_3").position_mm, Point(7, 8, 9));
    const std::string v2 =
        R"({"labels": [{"label": "all", "mask": [true, true, true]}, {"label": "chin", "mask": [false, false, true]}],
        "landmarks": {"connectivity": [], "points": [[1, 2, 3], [4, 5, 6], [7, 8, 9]]}, "version": 2})";
    EXPECT_EQ(read(v2.c_str()).at("chin").position_mm, Point(7, 8, 9));
    EXPECT_EQ(read(v2.c_str()).at("all_2").position_mm, Point(4, 5, 6));
    EXPECT_EQ(read((R"({"groups": {"LJSON": )" + v2 + R"(}, "version": 3})").c_str()).size(), 3U);
    EXPECT_THAT(message_of([&] { (void)read(R"({"landmarks": {"points": [[1, 2]]}})"); }),
                HasSubstr("marks in an image"));
    EXPECT_THAT(message_of([&] { (void)read("{}"); }), HasSubstr("has no 'landmarks'"));
}

TEST(ForeignLandmarks, of_lan_files_are_called_by_their_numbers) {
    std::string bytes;
    for (const float value : {9.F, 9.F, 9.F, 1.F, 2.F, 3.F, 4.F, 5.F, 6.F})
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    const auto marks = decode_landmarks(LandmarkFormat::lan, bytes, "l");
    ASSERT_EQ(marks.size(), 2U);
    EXPECT_EQ(marks.at("2").position_mm, Point(4, 5, 6));
    EXPECT_THAT(message_of([&] { (void)decode_landmarks(LandmarkFormat::lan, bytes.substr(1), "l"); }),
                HasSubstr("35 bytes"));
}

TEST(ForeignLandmarks, with_a_prefix_of_their_list_are_paired_by_order_on_request) {
    const TemporaryFolder folder;
    auto text = base::read_text(data / "to.csv");
    for (auto at = text.find("\nm"); at != std::string::npos; at = text.find("\nm", at + 1))
        text.insert(at + 1, "USNM_");
    base::write_atomically(folder / "to.csv", text);
    EXPECT_THAT(
        message_of([&] { (void)warp(data / "ref.ply", folder / "out.ply", data / "from.csv", folder / "to.csv"); }),
        testing::AllOf(HasSubstr("from.csv, "), HasSubstr("'USNM_m0'"), HasSubstr("--pair-by order")));
    const auto report =
        warp(data / "ref.ply", folder / "out.ply", data / "from.csv", folder / "to.csv", {.pair_by = PairBy::order});
    EXPECT_THAT(all_of(report.remarks), HasSubstr("paired by their order, 'm0'"));
    EXPECT_LT(
        largest_distance(read_mesh(data / "ref.ply").vertices_mm, read_mesh(folder / "out.ply").vertices_mm, moved),
        single_precision);
}

TEST(FarFromTheOrigin, an_stl_says_what_32_bits_lose) {
    const TemporaryFolder folder;
    const auto far = data / "far-from-origin";
    EXPECT_THAT(all_of(warp(far / "a.ply", folder / "out.stl", far / "from.csv", far / "to.csv").remarks),
                HasSubstr("the 32-bit numbers of STL lose up to 0.25 mm"));
    EXPECT_THAT(warp(data / "ref.ply", folder / "out.stl").remarks, IsEmpty());
}

}  // namespace
}  // namespace mimik::io
