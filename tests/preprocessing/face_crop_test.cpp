#include "preprocessing/face_crop.h"

#include <array>
#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "io/mesh_io.h"
#include "preprocessing/average_face.h"
#include "preprocessing/bake_texture.h"
#include "preprocessing/preprocess_scan.h"
#include "tests/support/analytic_face.h"
#include "tests/support/thrown.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::RangeScan;
using geometry::Transform;
using geometry::Vector;
using testing::Contains;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr double eyes_mm = 100.0;

/// Eyes 100 mm apart, the mouth straight below them in one plane: the axes are x, y and z, and the middle of the outer
/// eye corners is the origin.
geometry::Landmarks square_face() {
    std::vector<geometry::Landmark> marks;
    const auto pair = [&](const std::string& name, double x, double y) {
        marks.push_back({name + "_left", Point(x, y, 0), ""});
        marks.push_back({name + "_right", Point(-x, y, 0), ""});
    };
    pair("eye_outer", 50, 0);
    pair("eye_inner", 20, 0);
    pair("mouth_corner", 25, -70);
    marks.push_back({"nose_tip", Point(0, -45, 30), ""});
    marks.push_back({"chin", Point(0, -110, 0), ""});
    return geometry::Landmarks(std::move(marks));
}

geometry::Landmarks without(const geometry::Landmarks& landmarks, const std::string& name) {
    std::vector<geometry::Landmark> marks;
    for (const auto& mark : landmarks.all())
        if (mark.name != name) marks.push_back(mark);
    return geometry::Landmarks(std::move(marks));
}

/// Points 1 mm inside and 1 mm outside of each of the five ends of the default box of square_face().
struct Ends {
    std::vector<Point> inside, outside;
};
Ends ends() {
    const FaceCropOptions o;
    Ends ends;
    for (const double mm : {-1.0, 1.0}) {
        auto& points = mm < 0 ? ends.inside : ends.outside;
        points.emplace_back(o.half_width * eyes_mm + mm, 0, 0);
        points.emplace_back(-o.half_width * eyes_mm - mm, 0, 0);
        points.emplace_back(0, o.above_eyes * eyes_mm + mm, 0);
        points.emplace_back(0, -110 - o.below_chin * eyes_mm - mm, 0);
        points.emplace_back(0, 0, -o.behind_eyes * eyes_mm - mm);
    }
    ends.inside.emplace_back(0, -45, 500);  // nothing in front of a face is cut off
    return ends;
}

RangeScan cloud(const Ends& ends) {
    RangeScan scan;
    for (const auto* points : {&ends.inside, &ends.outside})
        for (const auto& p : *points) scan.points_mm.push_back(p);
    return scan;
}

TEST(FaceCrop, ends_where_its_options_say_in_outer_eye_distances) {
    const auto both = ends();
    const auto box = face_box(square_face());
    ASSERT_TRUE(box);
    for (const auto& p : both.inside) EXPECT_TRUE(box->holds(p)) << p.transpose();
    for (const auto& p : both.outside) EXPECT_FALSE(box->holds(p)) << p.transpose();
    FaceCropReport report;
    EXPECT_EQ(crop_to_face(cloud(both), *box, &report).points_mm, both.inside);
    EXPECT_EQ(report.points, both.inside.size() + both.outside.size());
    EXPECT_EQ(report.left_out, both.outside.size());
}

TEST(FaceCrop, a_tilted_head_is_cropped_upright) {
    const Transform tilt(Eigen::Translation3d(300, -200, 900) *
                         Eigen::AngleAxisd(0.9, Vector(0.3, 0.5, 1.0).normalized()));
    auto both = ends();
    const auto box = face_box(geometry::transformed(square_face(), tilt));
    ASSERT_TRUE(box);
    for (const auto& p : both.inside) EXPECT_TRUE(box->holds(tilt * p)) << p.transpose();
    for (const auto& p : both.outside) EXPECT_FALSE(box->holds(tilt * p)) << p.transpose();
}

TEST(FaceCrop, holds_the_crop_of_the_average_face_and_30_mm_of_skin_below_the_chin) {
    const AverageFaceOptions average;
    const FaceCropOptions crop;
    EXPECT_GT(crop.half_width, average.half_width + 0.1);
    EXPECT_GT(crop.above_eyes, average.above_eyes + 0.1);
    EXPECT_GT(crop.below_chin, average.below_chin + 0.1);
    EXPECT_GT(crop.below_chin * 80, 30);  // 80 mm: a small adult's outer-eye distance
}

TEST(FaceCrop, a_lattice_keeps_its_places_and_a_scan_of_a_face_alone_stays_as_it_is) {
    const test::AnalyticFace shape;
    const auto scan = shape.scan(2.0);
    const auto box = face_box(shape.landmarks());
    ASSERT_TRUE(box);
    FaceCropReport report;
    const auto same = crop_to_face(scan, *box, &report);
    EXPECT_EQ(report.left_out, 0U);
    ASSERT_EQ(same.points_mm.size(), scan.points_mm.size());
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
        ASSERT_EQ(same.valid(i), scan.valid(i));
        if (scan.valid(i)) {
            ASSERT_EQ(same.points_mm[i], scan.points_mm[i]);
        }
    }
    EXPECT_EQ(same.texture_coordinates, scan.texture_coordinates);

    auto with_shoulder = scan;
    const std::size_t shoulder = 0;  // the place in the lowest corner measured nothing
    ASSERT_FALSE(scan.valid(shoulder));
    with_shoulder.points_mm[shoulder] = Point(0, -150, -40);
    const auto cropped = crop_to_face(with_shoulder, *box, &report);
    EXPECT_EQ(report.left_out, 1U);
    EXPECT_EQ(cropped.rows, scan.rows);
    EXPECT_EQ(cropped.points_mm.size(), scan.points_mm.size());
    EXPECT_FALSE(cropped.valid(shoulder));
}

/// The face in closed form, its skin going on to the shoulders 230 mm wide and 250 mm below the chin.
RangeScan bust() {
    using Face = test::AnalyticFace;
    auto mesh = Face{}.mesh(Face::lines(-116, 116, 4), Face::lines(-300, 88, 4));
    for (const auto& p : mesh.points_mm) mesh.texture_coordinates.emplace_back(p.x() / 300, p.y() / 300);
    return mesh;
}

TEST(FaceCrop, of_a_mesh_the_faces_go_with_their_corners_and_texture_stays_at_its_point) {
    const auto mesh = bust();
    const auto box = face_box(test::AnalyticFace{}.landmarks());
    ASSERT_TRUE(box);
    FaceCropReport report;
    const auto cropped = crop_to_face(mesh, *box, &report);
    EXPECT_EQ(cropped.points_mm.size(), report.points - report.left_out);
    EXPECT_EQ(cropped.faces.size(), mesh.faces.size() - report.faces_left_out);
    std::size_t whole = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        bool held = true;
        for (const auto v : mesh.faces[f]) held = held && box->holds(mesh.points_mm[v]);
        whole += held ? 1 : 0;
    }
    EXPECT_EQ(cropped.faces.size(), whole);
    ASSERT_EQ(cropped.texture_coordinates.size(), cropped.points_mm.size());
    for (std::size_t i = 0; i < cropped.points_mm.size(); ++i) {
        EXPECT_TRUE(box->holds(cropped.points_mm[i]));
        EXPECT_NEAR(cropped.texture_coordinates[i].y(), cropped.points_mm[i].y() / 300, 1e-12);
    }
}

/// 22 marks, two ear lobes 110 mm behind the eyes, and a bust around them.
database::LoadedScan bust_with_ears() {
    database::LoadedScan loaded;
    loaded.entry.id = {"bs000", "N", "N", 0};
    loaded.scan = bust();
    const auto marks = test::AnalyticFace{}.landmarks();
    std::vector<geometry::Landmark> with_ears(marks.all().begin(), marks.all().end());
    with_ears.push_back({"ear_lobe_left", Point(75, 0, -120), ""});
    with_ears.push_back({"ear_lobe_right", Point(-75, 0, -120), ""});
    loaded.landmarks = geometry::Landmarks(std::move(with_ears));
    return loaded;
}

TEST(FaceCrop, the_grid_of_a_bust_lies_on_its_face_and_with_keep_all_on_its_shoulders_too) {
    const auto loaded = bust_with_ears();
    ScanSteps steps;
    ScanStepsReport report;
    const auto face = preprocess_scan(loaded, steps, &report);
    EXPECT_GT(report.crop.left_out, report.crop.points / 2);
    EXPECT_THAT(face.remarks, Contains(HasSubstr("cropped to the face: ")));
    const auto box = face_box(loaded.landmarks);
    ASSERT_TRUE(box);
    for (std::size_t v = 0; v < face.grid.size(); ++v)
        if (face.grid.measured(v)) {
            ASSERT_TRUE(box->holds(face.grid.vertices_mm[v]));
        }
    steps.crop.crop = false;
    const auto whole = preprocess_scan(loaded, steps, &report);
    EXPECT_EQ(report.crop.left_out, 0U);
    EXPECT_THAT(whole.remarks, Not(Contains(HasSubstr("cropped"))));
    EXPECT_NEAR(whole.grid.vertices_mm.front().y(), -300, 1e-9);
    const auto step_mm = [](const Face& f) {
        const auto& p = f.grid.vertices_mm;
        return p[static_cast<std::size_t>(f.grid.cols)].y() - p[0].y();
    };
    EXPECT_LT(step_mm(face), 0.65 * step_mm(whole));
}

TEST(FaceCrop, an_ear_that_was_cut_off_has_no_snapped_place_but_its_mark_stays) {
    auto loaded = bust_with_ears();
    const auto face = preprocess_scan(loaded);
    EXPECT_TRUE(face.landmarks.find("ear_lobe_left"));
    EXPECT_FALSE(face.snapped_landmarks.find("ear_lobe_left"));
    EXPECT_EQ(face.snapped_landmarks.size(), 22U);
    ScanSteps all;
    all.crop.crop = false;
    EXPECT_TRUE(preprocess_scan(loaded, all).snapped_landmarks.find("ear_lobe_left"));
}

TEST(FaceCrop, a_picture_for_the_cropped_grid_is_painted_from_the_charts_of_the_whole_scan) {
    const auto mesh = bust();
    geometry::TextureCharts charts;
    charts.points_mm = mesh.points_mm;
    charts.faces = mesh.faces;
    charts.faces.texture_corners = mesh.faces.corners;
    for (const auto& p : mesh.points_mm) charts.positions.emplace_back((p.x() + 150) / 300, 0.5);
    io::Image image{100, 1, {}};  // red at the subject's right, green at the left
    constexpr std::uint8_t full = 200, none = 0;
    for (int x = 0; x < 100; ++x) {
        const std::array<std::uint8_t, 3> colour = {x < 50 ? full : none, x < 50 ? none : full, none};
        image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
    }
    const auto box = face_box(test::AnalyticFace{}.landmarks());
    ASSERT_TRUE(box);
    auto grid = grid_scan(crop_to_face(mesh, *box));
    const std::vector<std::optional<io::Image>> images = {image};
    const auto picture = bake_texture(charts, images, grid);
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.measured(v) || std::abs(grid.vertices_mm[v].x()) < 5) continue;
        const auto& uv = grid.texture_coordinates[v];
        const auto x = static_cast<std::size_t>(uv.x() * picture.width);
        const auto y = static_cast<std::size_t>((1 - uv.y()) * picture.height);
        const auto first = 3 * (y * static_cast<std::size_t>(picture.width) + x);
        const std::size_t channel = grid.vertices_mm[v].x() < 0 ? 0 : 1;
        ASSERT_EQ(picture.rgb[first + channel], 200) << grid.vertices_mm[v].transpose();
    }
}

TEST(FaceCrop, without_a_chin_nothing_is_cropped_and_a_remark_says_so) {
    auto loaded = bust_with_ears();
    loaded.landmarks = without(loaded.landmarks, "chin");
    std::string lacking;
    EXPECT_FALSE(face_box(loaded.landmarks, {}, &lacking));
    EXPECT_EQ(lacking, "landmark 'chin' is missing");
    const auto face = preprocess_scan(loaded);
    EXPECT_THAT(face.remarks, Contains("not cropped to the face: landmark 'chin' is missing"));
    EXPECT_NEAR(face.grid.vertices_mm.front().y(), -300, 1e-9);
}

/// A whole head of somebody else's: x out of the face, z up, the axis through the ears at the origin.
fs::path whole_head_file() {
    const char* shared = std::getenv("MIMIK_SHARED_DATA");
    return (shared ? fs::path(shared) : fs::path(MIMIK_SOURCE_DIR) / ".." / "shared" / "data") / "hrtf-head" /
           "head.ply";
}

TEST(FaceCrop, of_a_whole_head_the_ears_and_the_neck_go_and_the_face_gets_their_vertices) {
    if (!fs::exists(whole_head_file())) GTEST_SKIP() << "no head in " << whole_head_file();
    const auto mesh = io::read_mesh(whole_head_file());
    database::LoadedScan loaded;
    loaded.entry.id = {"bs000", "N", "N", 0};
    for (const auto& p : mesh.vertices_mm) loaded.scan.points_mm.emplace_back(p.y(), p.z(), p.x());
    loaded.scan.faces = mesh.faces;
    loaded.landmarks = geometry::Landmarks({{"eye_outer_left", {43, 26.5, 86.8}, ""},
                                            {"eye_outer_right", {-42.9, 26, 88.2}, ""},
                                            {"eye_inner_left", {18.1, 25.6, 87.6}, ""},
                                            {"eye_inner_right", {-15.4, 23.2, 87.8}, ""},
                                            {"mouth_corner_left", {22.7, -47.4, 85.9}, ""},
                                            {"mouth_corner_right", {-22.5, -45.7, 90.6}, ""},
                                            {"nose_tip", {1.3, -14.9, 126.7}, ""},
                                            {"chin", {0.1, -66.3, 90.5}, ""}});
    ScanSteps steps;
    ScanStepsReport report;
    const auto face = preprocess_scan(loaded, steps, &report);
    const auto box = face_box(loaded.landmarks);
    ASSERT_TRUE(box);
    for (const auto& p : crop_to_face(loaded.scan, *box).points_mm) {
        ASSERT_GT(p.z(), 0);     // the ears' openings lie at z = 0
        ASSERT_GT(p.y(), -120);  // the collar at -123
    }
    steps.crop.crop = false;
    const auto whole = preprocess_scan(loaded, steps);
    const auto on_face = [](const Face& f) {  // between ears, hairline and chin
        std::size_t count = 0;
        for (std::size_t v = 0; v < f.grid.size(); ++v) {
            const auto& p = f.grid.vertices_mm[v];
            count += f.grid.measured(v) && std::abs(p.x()) < 70 && p.y() > -82 && p.y() < 100 ? 1 : 0;
        }
        return static_cast<double>(count);
    };
    EXPECT_GT(on_face(face), 1.35 * on_face(whole));
}

TEST(FaceCrop, bad_options_and_a_scan_somewhere_else_are_refused_by_name) {
    FaceCropOptions narrow;
    narrow.half_width = 0.1;
    EXPECT_THAT(test::message_of<InputError>([&] { narrow.check(); }), HasSubstr("half_width of the crop is 0.1"));
    EXPECT_NO_THROW(FaceCropOptions{}.check());
    const auto box = face_box(square_face());
    ASSERT_TRUE(box);
    RangeScan elsewhere;
    elsewhere.points_mm.assign(10, Point(0, 0, -5000));
    EXPECT_THAT(test::message_of<InputError>([&] { (void)crop_to_face(elsewhere, *box); }),
                HasSubstr("10 of 10 points lie outside the face"));
}

}  // namespace
}  // namespace mimik::preprocessing
