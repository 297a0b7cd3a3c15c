#include "evaluation/active_zone.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace.h"
#include "tests/support/expressions.h"

namespace mimik::evaluation {
namespace {

using geometry::Point;
using geometry::Transform;

class ActiveZoneTest : public testing::Test {
protected:
    static void SetUpTestSuite() {
        average_ = new preprocessing::AverageFace(test::analytic_average());
        pose_ = Transform(Eigen::Translation3d(5, -3, 40) * Eigen::AngleAxisd(0.05, Point::UnitY()));
        neutral_ = new preprocessing::Face(test::analytic_face({scale, 0}, "N", pose_));
        neutral_->average_from_scan = preprocessing::similarity_normalisation(neutral_->landmarks, average_->landmarks);
    }
    static void TearDownTestSuite() {
        delete neutral_;
        delete average_;
    }
    static std::vector<geometry::Vector> motion() {
        const auto at_rest = test::analytic_truth("bs000_N_N_0", {scale, 0}, pose_);
        const auto smiling = test::analytic_truth("bs000_LFAU_12_0", {scale, smile_mm}, test::analytic_pose(1));
        return true_motion_on_average(*average_, *neutral_, at_rest, smiling.displacement_mm);
    }
    static ActiveZone zone(double share = 0.2) {
        MotionZone sum(*average_);
        sum.add(motion());
        return sum.zone(test::expression("12"), share);
    }
    /// Length of the smile's shift at a point of the unit face.
    static double shift_mm(const Point& head) {
        return test::AnalyticFace{1.0, smile_mm}.shift(head.x(), head.y()).norm();
    }
    static constexpr double scale = 1.1, smile_mm = 6;
    static preprocessing::AverageFace* average_;
    static preprocessing::Face* neutral_;
    static Transform pose_;
};

preprocessing::AverageFace* ActiveZoneTest::average_ = nullptr;
preprocessing::Face* ActiveZoneTest::neutral_ = nullptr;
Transform ActiveZoneTest::pose_;

TEST_F(ActiveZoneTest, from_a_truth_is_the_known_field_on_the_average_face) {
    const auto found = zone();
    const auto head_from_average =
        preprocessing::rigid_by_landmarks(average_->landmarks, test::AnalyticFace{}.landmarks());
    std::size_t active = 0;
    for (std::size_t v = 0; v < average_->grid.size(); ++v) {
        if (!average_->grid.inside(v)) {
            EXPECT_FALSE(found.active[v]);
            continue;
        }
        const Point head = head_from_average * average_->grid.vertices_mm[v];
        if (std::abs(head.x()) > 55 || std::abs(head.y()) > 65) continue;  // the true surface ends there
        // A lattice of 3 mm leaves h^2 / 8 f'' = 0.05 mm of a bump of 12 mm width, and the nearest point on its chords
        // lies up to 0.5 mm beside, where the field differs by 0.5 * 6 / 12 * 0.6 = 0.15 mm.
        EXPECT_NEAR(found.displacement_mm[v], shift_mm(head), 0.25) << head.transpose();
        active += found.active[v] ? 1 : 0;
        if (shift_mm(head) > 0.26 * smile_mm) {
            EXPECT_TRUE(found.active[v]) << head.transpose();
        }
        if (shift_mm(head) < 0.14 * smile_mm) {
            EXPECT_FALSE(found.active[v]) << head.transpose();
        }
    }
    EXPECT_GT(active, 500U);
}

TEST_F(ActiveZoneTest, is_carried_to_a_face_of_other_size_and_pose) {
    const auto here = carry_zone(zone(), *average_, *neutral_);
    std::size_t active = 0;
    for (std::size_t v = 0; v < here.size(); ++v) {
        if (!neutral_->grid.inside(v)) {
            EXPECT_FALSE(here[v]);
            continue;
        }
        const Point head = pose_.inverse() * neutral_->grid.vertices_mm[v] / scale;
        if (std::abs(head.x()) > 55 || std::abs(head.y()) > 65) continue;
        active += here[v] ? 1 : 0;
        // Cells of the average face are 1 x 1.2 mm: half a cell, where the field changes by 0.3 mm per mm.
        if (shift_mm(head) > 0.30 * smile_mm) {
            EXPECT_TRUE(here[v]) << head.transpose();
        }
        if (shift_mm(head) < 0.11 * smile_mm) {
            EXPECT_FALSE(here[v]) << head.transpose();
        }
    }
    EXPECT_GT(active, 500U);
}

TEST_F(ActiveZoneTest, a_smaller_share_is_a_larger_zone_and_no_subject_is_refused) {
    const auto count = [](double share) {
        const auto found = zone(share);
        return std::count(found.active.begin(), found.active.end(), 1);
    };
    EXPECT_GT(count(0.1), count(0.2));
    EXPECT_THROW((void)MotionZone(*average_).zone(test::expression("12")), InputError);
}

TEST_F(ActiveZoneTest, of_several_subjects_is_that_of_their_mean) {
    const auto one = motion();
    std::vector<geometry::Vector> twice, opposite;
    for (const auto& way : one) {
        twice.push_back(2 * way);
        opposite.push_back(-way);
    }
    MotionZone sum(*average_);
    sum.add(one);
    sum.add(twice);
    sum.add(opposite);
    const auto alone = zone(), mean = sum.zone(test::expression("12"));  // (1 + 2 - 1) / 3
    for (std::size_t v = 0; v < one.size(); ++v)
        // Rounding of a few mm.
        EXPECT_NEAR(mean.displacement_mm[v], 2.0 / 3.0 * alone.displacement_mm[v], 1e-12);
}

TEST_F(ActiveZoneTest, of_the_catalogue_holds_the_mouth_corners_and_not_the_brows) {
    const auto drawn = shipped_active_zone(test::expression("12"), *average_);
    const auto at = [&](const char* name) {
        std::size_t nearest = 0;
        double best = 1e9;
        for (std::size_t v = 0; v < average_->grid.size(); ++v)
            if (average_->grid.inside(v)) {
                const double d = (average_->grid.vertices_mm[v] - average_->landmarks.position_mm(name)).norm();
                if (d < best) best = d, nearest = v;
            }
        return static_cast<bool>(drawn.active[nearest]);
    };
    EXPECT_TRUE(at("mouth_corner_left") && at("mouth_corner_right"));
    EXPECT_FALSE(at("brow_middle_left") || at("brow_middle_right"));
}

}  // namespace
}  // namespace mimik::evaluation
