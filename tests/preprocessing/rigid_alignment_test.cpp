#include "preprocessing/rigid_alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/analytic_face.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::Transform;

struct Surface {
    std::vector<Point> vertices;
    std::vector<geometry::Triangle> triangles;
};

Surface surface_of(const test::AnalyticFace& face) {
    const auto scan = face.scan(1.0);
    Surface surface;
    surface.vertices = scan.points_mm;
    for (auto& p : surface.vertices)
        if (!p.allFinite()) p.setZero();
    const auto at = [&](int row, int col) { return static_cast<std::uint32_t>(row * scan.cols + col); };
    for (int row = 0; row + 1 < scan.rows; ++row)
        for (int col = 0; col + 1 < scan.cols; ++col)
            if (scan.valid(at(row, col)) && scan.valid(at(row, col + 1)) && scan.valid(at(row + 1, col)) &&
                scan.valid(at(row + 1, col + 1))) {
                surface.triangles.push_back({at(row, col), at(row, col + 1), at(row + 1, col + 1)});
                surface.triangles.push_back({at(row, col), at(row + 1, col + 1), at(row + 1, col)});
            }
    return surface;
}

std::vector<Point> upper_face_points(const test::AnalyticFace& face) {
    std::vector<Point> points;
    for (double y = 0; y <= 60; y += 2)
        for (double x = -50; x <= 50; x += 2) points.push_back(face.point(x, y));
    return points;
}

TEST(RigidAlignment, recovers_a_known_motion_from_the_part_that_does_not_move) {
    const test::AnalyticFace neutral, smiling{1.0, 8.0};
    const auto target = surface_of(smiling);
    const Transform target_from_source(Eigen::Translation3d(2, -1.5, 3) *
                                       Eigen::AngleAxisd(0.06, Point(0.2, 1, -0.3).normalized()));
    auto source = upper_face_points(neutral);
    for (auto& p : source) p = target_from_source.inverse() * p;
    const auto found = align_rigidly(source, geometry::SurfaceIndex(target.vertices, target.triangles));
    EXPECT_TRUE(found.converged);
    double worst = 0;
    for (const auto& p : source)
        worst = std::max(worst, (found.target_from_source * p - target_from_source * p).norm());
    // The 1 mm mesh of the target cuts the corners of the true surface by some hundredths of a millimetre.
    EXPECT_LT(worst, 0.05);
    EXPECT_LT(found.rms_mm, 0.03);
}

TEST(RigidAlignment, trimming_ignores_a_region_that_moved) {
    const test::AnalyticFace neutral, smiling{1.0, 10.0};
    const auto target = surface_of(smiling);
    auto source = upper_face_points(neutral);
    for (double y = -45; y <= -20; y += 2)
        for (double x = -40; x <= 40; x += 2) source.push_back(neutral.point(x, y));
    const geometry::SurfaceIndex index(target.vertices, target.triangles);
    const auto trimmed = align_rigidly(source, index, Transform::Identity(), {.trim = 0.6});
    const auto all = align_rigidly(source, index, Transform::Identity(), {.trim = 1.0});
    const Point brow = neutral.point(30, 50);
    EXPECT_LT((trimmed.target_from_source * brow - brow).norm(), 0.1);
    EXPECT_GT((all.target_from_source * brow - brow).norm(), 2 * (trimmed.target_from_source * brow - brow).norm());
}

TEST(RigidAlignment, points_of_weight_nothing_do_not_pull_and_like_weights_change_nothing) {
    const test::AnalyticFace neutral, smiling{1.0, 10.0};
    const auto target = surface_of(smiling);
    const geometry::SurfaceIndex index(target.vertices, target.triangles);
    const auto upper = upper_face_points(neutral);
    auto source = upper;
    for (double y = -45; y <= -20; y += 2)
        for (double x = -40; x <= 40; x += 2) source.push_back(neutral.point(x, y));
    std::vector<double> weights(source.size(), 0.0);
    std::fill_n(weights.begin(), upper.size(), 3.0);
    const RigidAlignmentOptions all{.trim = 1.0, .max_points = 10'000};
    const auto alone = align_rigidly(upper, index, Transform::Identity(), all);
    const auto weighted = align_rigidly(source, index, Transform::Identity(), all, weights);
    // The same sums but for the factor 3; points on an edge of the mesh go to either side of it by rounding, and steps
    // end at 0.002 mm.
    const Point brow = neutral.point(30, 50);
    EXPECT_LT((weighted.target_from_source * brow - alone.target_from_source * brow).norm(), 0.002);
    EXPECT_NEAR(weighted.rms_mm, alone.rms_mm, 1e-5);
    const auto plain = align_rigidly(source, index, Transform::Identity(), all);
    EXPECT_GT((plain.target_from_source * brow - alone.target_from_source * brow).norm(), 0.05);
}

TEST(RigidAlignment, weights_that_are_too_few_or_negative_are_refused) {
    const auto target = surface_of({});
    const geometry::SurfaceIndex index(target.vertices, target.triangles);
    const auto source = upper_face_points({});
    std::vector<double> weights(source.size() - 1, 1.0);
    EXPECT_THROW((void)align_rigidly(source, index, Transform::Identity(), {}, weights), InputError);
    weights.assign(source.size(), 1.0);
    weights[7] = -1;
    EXPECT_THROW((void)align_rigidly(source, index, Transform::Identity(), {}, weights), InputError);
    weights.assign(source.size(), 0.0);
    EXPECT_THROW((void)align_rigidly(source, index, Transform::Identity(), {}, weights), NumericalError);
}

TEST(RigidAlignment, a_scan_far_away_is_refused_with_counts) {
    const auto target = surface_of({});
    std::vector<Point> far(100, Point(0, 0, 5000));
    try {
        (void)align_rigidly(far, geometry::SurfaceIndex(target.vertices, target.triangles));
        FAIL() << "accepted";
    } catch (const NumericalError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("only 0 of 100 points"));
    }
}

/// 6,161 points of the face, turned and shifted off it by some millimetres.
std::vector<Point> turned_upper_face() {
    const Transform source_from_target =
        Transform(Eigen::Translation3d(1, 2, -1) * Eigen::AngleAxisd(0.03, Point::UnitY())).inverse();
    std::vector<Point> points;
    for (double y = 0; y <= 60; y += 1)
        for (double x = -50; x <= 50; x += 1) points.push_back(source_from_target * test::AnalyticFace{}.point(x, y));
    return points;
}

TEST(RigidAlignment, a_tenth_of_the_points_finds_the_same_motion) {
    const auto source = turned_upper_face();
    const auto target = surface_of({});
    const geometry::SurfaceIndex index(target.vertices, target.triangles);
    const auto some = align_rigidly(source, index, Transform::Identity(), {.max_points = 600});
    const auto all = align_rigidly(source, index, Transform::Identity(), {.max_points = 10'000});
    EXPECT_EQ(all.pairs_used, static_cast<std::size_t>(std::ceil(0.7 * static_cast<double>(source.size()))));
    EXPECT_LT(some.pairs_used, 600U);
    // Points on the surface itself: both stop within some steps of 0.002 mm of the same pose.
    for (const auto& p : source) ASSERT_LT((some.target_from_source * p - all.target_from_source * p).norm(), 0.03);
}

TEST(RigidAlignment, first_steps_with_few_points_end_where_all_points_end) {
    const auto source = turned_upper_face();
    const auto target = surface_of({});
    const geometry::SurfaceIndex index(target.vertices, target.triangles);
    const auto coarse = align_rigidly(source, index, Transform::Identity(), {.coarse_points = 200});
    const auto plain = align_rigidly(source, index, Transform::Identity(), {.coarse_points = 0});
    EXPECT_TRUE(coarse.converged);
    EXPECT_EQ(coarse.pairs_used, plain.pairs_used);  // the last step is made with all
    EXPECT_NEAR(coarse.rms_mm, plain.rms_mm, 1e-3);
    // Both stop within some steps of 0.002 mm of the same pose.
    for (const auto& p : source) ASSERT_LT((coarse.target_from_source * p - plain.target_from_source * p).norm(), 0.03);
}

TEST(RigidAlignment, too_few_points_in_the_first_steps_leave_the_work_to_all) {
    // Every 50th point lies on the face, and the first steps, which take every 7th, see 18 of them.
    const test::AnalyticFace face;
    const auto target = surface_of(face);
    std::vector<Point> source;
    for (double y = 0; y <= 60; y += 1)
        for (double x = -50; x <= 50; x += 1)
            source.push_back(source.size() % 50 == 0 ? face.point(x, y) : Point(0, 0, 5000));
    const geometry::SurfaceIndex index(target.vertices, target.triangles);
    const auto found =
        align_rigidly(source, index, Transform::Identity(), {.trim = 1.0, .max_points = 10'000, .coarse_points = 1000});
    EXPECT_TRUE(found.converged);
    EXPECT_GT(found.pairs_used, 30U);
}

TEST(RigidAlignmentOptions, defaults_are_valid_and_a_trim_of_zero_is_not) {
    EXPECT_NO_THROW(RigidAlignmentOptions{}.check());
    EXPECT_THROW(RigidAlignmentOptions{.trim = 0}.check(), InputError);
    EXPECT_THROW(RigidAlignmentOptions{.max_points = 0}.check(), InputError);
}

}  // namespace
}  // namespace mimik::preprocessing
