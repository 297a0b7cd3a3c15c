#include "preprocessing/average_face.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "preprocessing/preprocess_scan.h"
#include "tests/support/analytic_face.h"

namespace mimik::preprocessing {
namespace {

using geometry::Landmarks;
using geometry::Point;
using geometry::Transform;

TEST(ConsensusLandmarks, of_copies_that_were_turned_and_shifted_is_the_face_itself) {
    const auto marks = test::AnalyticFace{}.landmarks();
    std::vector<Landmarks> sets;
    for (const double angle : {-0.1, 0.0, 0.1})  // turns that cancel, so the mean orientation is frontal
        sets.push_back(geometry::transformed(
            marks, Transform(Eigen::Translation3d(10 * angle, 5, 100) * Eigen::AngleAxisd(angle, Point::UnitY()))));
    double rms_mm = 1;
    const auto consensus = consensus_landmarks(sets, 50, &rms_mm);
    EXPECT_LT(rms_mm, 1e-8);
    const Point nose = marks.position_mm("nose_tip");
    for (const auto& mark : marks.all())
        // The mean of copies turned by 0.1 rad is 2 / 3 (1 - cos 0.1) = 0.3 % narrower and shallower than the face, and
        // the pitch that lays the face best on it differs by some 1e-4 rad: 0.02 mm at 100 mm.
        EXPECT_LT((consensus.position_mm(mark.name) - (mark.position_mm - nose)).norm(), 0.05) << mark.name;
}

TEST(ConsensusLandmarks, is_mirror_symmetric_with_the_nose_tip_at_the_origin) {
    std::vector<Landmarks> sets;
    for (const double scale : {0.9, 1.0, 1.15}) sets.push_back(test::AnalyticFace{scale, 6 * scale}.landmarks());
    const auto consensus = consensus_landmarks(sets);
    EXPECT_LT(consensus.position_mm("nose_tip").norm(), 1e-12);
    const Point left = consensus.position_mm("mouth_corner_left"), right = consensus.position_mm("mouth_corner_right");
    EXPECT_NEAR(left.x(), -right.x(), 1e-9);
    EXPECT_NEAR(left.y(), right.y(), 1e-9);
    EXPECT_GT(left.x(), 0);
}

TEST(ConsensusLandmarks, marks_that_few_have_and_marks_that_are_missing_change_no_size) {
    const auto marks = test::AnalyticFace{}.landmarks();
    std::vector<geometry::Landmark> more(marks.all().begin(), marks.all().end()), fewer;
    more.push_back({"ear_lobe_left", {80, -20, -90}, ""});
    more.push_back({"ear_lobe_right", {-80, -20, -90}, ""});
    for (const auto& mark : marks.all())
        if (mark.name != "chin" && mark.name != "brow_outer_left") fewer.push_back(mark);
    const std::vector<Landmarks> sets = {marks, marks, Landmarks(more), Landmarks(fewer)};
    const auto consensus = consensus_landmarks(sets);
    EXPECT_EQ(consensus.find("ear_lobe_left"), nullptr);
    const double eyes_mm = (consensus.position_mm("eye_outer_left") - consensus.position_mm("eye_outer_right")).norm();
    EXPECT_NEAR(eyes_mm, 90.0, 1e-6);  // all four faces are the same one
}

TEST(ConsensusLandmarks, one_face_is_no_average) {
    const std::vector<Landmarks> one = {test::AnalyticFace{}.landmarks()};
    EXPECT_THROW((void)consensus_landmarks(one), InputError);
}

TEST(AverageFace, of_equal_faces_is_that_face_with_its_nose_tip_at_the_origin) {
    const test::AnalyticFace face;
    database::LoadedScan loaded;
    loaded.scan = face.scan(1.0);
    loaded.landmarks = face.landmarks();
    loaded.entry.id = {"bs000", "N", "N", 0};
    const Face gridded = preprocess_scan(loaded);
    const std::vector<Landmarks> sets = {gridded.landmarks, gridded.landmarks};
    const auto average = build_average_face(
        2, [&](std::size_t) { return gridded; }, consensus_landmarks(sets));
    std::size_t compared = 0;
    for (std::size_t v = 0; v < average.grid.size(); ++v) {
        const Point& p = average.grid.vertices_mm[v];
        if (!average.grid.inside(v) || std::abs(p.x()) > 50 || p.y() > 70 || p.y() < -60) continue;
        ++compared;
        // Depth of the closed form less that of the tip. Linear interpolation leaves h^2 / 8 * z'': in the fold
        // between the lips (2 / 1.5^2 per mm) 0.11 mm for the 1 mm lattice and 0.17 mm for rows 1.23 mm apart.
        EXPECT_NEAR(p.z(), test::AnalyticFace::depth(p.x(), p.y()) - test::AnalyticFace::depth(0, 0), 0.29)
            << p.transpose();
    }
    EXPECT_GT(compared, 5000U);
}

/// Faces in closed form that lack what `lost` says of a place on them.
template <typename Lost>
AverageFace average_of_faces_without(const Lost& lost) {
    const test::AnalyticFace face;
    database::LoadedScan loaded;
    loaded.scan = face.scan(1.0);
    for (auto& p : loaded.scan.points_mm)
        if (lost(p)) p.setConstant(std::numeric_limits<double>::quiet_NaN());
    loaded.landmarks = face.landmarks();
    loaded.entry.id = {"bs000", "N", "N", 0};
    const Face gridded = preprocess_scan(loaded);
    const std::vector<Landmarks> sets = {gridded.landmarks, gridded.landmarks};
    return build_average_face(
        2, [&](std::size_t) { return gridded; }, consensus_landmarks(sets));
}

bool at_left_brow(const Point& p) { return std::hypot((p.x() - 30) / 14, (p.y() - 45) / 6) < 1; }

TEST(AverageFace, a_brow_that_no_scan_shows_is_bridged_and_says_so) {
    const auto average = average_of_faces_without(at_left_brow);
    std::size_t bridged = 0;
    for (std::size_t v = 0; v < average.grid.size(); ++v) {
        const Point& p = average.grid.vertices_mm[v];
        if (std::hypot((p.x() - 30) / 12, (p.y() - 45) / 4) < 1) {
            ASSERT_EQ(average.grid.origin[v], geometry::VertexOrigin::bridged) << p.transpose();
            ++bridged;
            // From the eye hollow (-5 mm) up to the brow (+3 mm) the face bends both ways about a straight bridge: 1/9.
            EXPECT_NEAR(p.z(), test::AnalyticFace::depth(p.x(), p.y()) - test::AnalyticFace::depth(0, 0), 0.9);
        } else if (std::hypot((p.x() + 30) / 12, (p.y() - 45) / 4) < 1) {
            ASSERT_EQ(average.grid.origin[v], geometry::VertexOrigin::measured) << p.transpose();
        }
    }
    EXPECT_GT(bridged, 50U);
}

TEST(AverageFace, has_no_step_where_one_of_its_faces_ends) {
    // The second face has cheeks 4 mm deeper, and part of them was not measured.
    const auto deeper_mm = [](const Point& p) { return 4.0 * std::clamp((std::abs(p.x()) - 25) / 10, 0.0, 1.0); };
    const auto lost = [](double x, double y) { return std::abs(x) > 47 && y < 0 && y > -40; };
    std::vector<Face> faces;
    for (const bool second : {false, true}) {
        const test::AnalyticFace face;
        database::LoadedScan loaded;
        loaded.scan = face.scan(1.0);
        for (auto& p : loaded.scan.points_mm) {
            if (second && lost(p.x(), p.y())) p.setConstant(std::numeric_limits<double>::quiet_NaN());
            if (second) p.z() -= deeper_mm(p);
        }
        loaded.landmarks = face.landmarks();
        loaded.entry.id = {"bs000", "N", "N", 0};
        faces.push_back(preprocess_scan(loaded));
        faces.back().landmarks = face.landmarks();
    }
    const std::vector<Landmarks> sets = {faces[0].landmarks, faces[1].landmarks};
    const auto average = build_average_face(
        2, [&](std::size_t k) { return faces[k]; }, consensus_landmarks(sets));
    const auto& grid = average.grid;
    const auto closed_form_mm = [&](const Point& p) {
        return test::AnalyticFace::depth(p.x(), p.y()) - 0.5 * deeper_mm(p);
    };
    std::size_t at_border = 0;
    for (std::size_t v = 0; v + 1 < grid.size(); ++v) {
        const Point &p = grid.vertices_mm[v], &q = grid.vertices_mm[v + 1];
        if (!grid.inside(v) || !grid.inside(v + 1) || q.x() < p.x() || p.y() > -5 || p.y() < -35) continue;
        if (std::abs(std::abs(p.x()) - 47) > 3) continue;
        ++at_border;
        // The mean of those measured steps by 2 mm here. Left is what sampling rounds (0.1 mm) and the pull towards
        // that mean: 2 mm over 30 cells.
        EXPECT_NEAR(q.z() - p.z(), closed_form_mm(q) - closed_form_mm(p), 0.3) << p.transpose();
    }
    EXPECT_GT(at_border, 100U);
}

TEST(AverageFace, has_one_outline_for_both_sides) {
    const auto average = average_of_faces_without([](const Point& p) { return p.x() > 45 && p.y() < 0; });
    const auto cols = static_cast<std::size_t>(average.grid.cols);
    std::size_t outside = 0;
    for (std::size_t v = 0; v < average.grid.size(); ++v) {
        const auto mirrored = v - v % cols + (cols - 1 - v % cols);
        ASSERT_EQ(average.grid.inside(v), average.grid.inside(mirrored)) << average.grid.vertices_mm[v].transpose();
        const Point& p = average.grid.vertices_mm[v];
        if (p.x() < -47 && p.x() > -52 && p.y() < -10 && p.y() > -20) {
            EXPECT_FALSE(average.grid.inside(v)) << p.transpose();  // measured, but its partner is not
            ++outside;
        }
    }
    EXPECT_GT(outside, 10U);
}

}  // namespace
}  // namespace mimik::preprocessing
