#include "video/head_pose.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::video {
namespace {

constexpr int width = 640, height = 480;
constexpr double degree = EIGEN_PI / 180;

capture::HeadPose turned(double yaw, double pitch, double roll, const Eigen::Vector3d& shift_mm) {
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()))
            .toRotationMatrix() *
        Eigen::Vector3d(1, -1, -1).asDiagonal();
    const Eigen::AngleAxisd axis(turn);
    return {axis.angle() * axis.axis(), shift_mm};
}

Points68 seen(const std::array<geometry::Point, 68>& head_mm, const capture::HeadPose& pose) {
    Points68 points;
    const double angle = pose.rotation_vector.norm();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, pose.rotation_vector / angle).toRotationMatrix();
    for (std::size_t k = 0; k < 68; ++k) {
        const Eigen::Vector3d p = turn * head_mm[k] + pose.translation_mm;
        points[k] = {1.2 * width * p.x() / p.z() + 0.5 * (width - 1), 1.2 * width * p.y() / p.z() + 0.5 * (height - 1)};
    }
    return points;
}

TEST(HeadPose, a_known_turn_and_place_is_recovered) {
    const auto& mean = mean_face_points68_mm();
    const auto rest = turned(0, 0, 0, {5, -10, 600});
    const FittedHead head(seen(mean, rest), known_on_curves(), width, height);
    const auto truth = turned(12 * degree, -6 * degree, 4 * degree, {30, -15, 640});
    const auto pose = head.pose(seen(mean, truth), rest);
    ASSERT_TRUE(pose);
    // Without noise only the solver's own stop is left.
    EXPECT_LT((pose->rotation_vector - truth.rotation_vector).norm(), 0.1 * degree);
    EXPECT_LT((pose->translation_mm - truth.translation_mm).norm(), 1.0);
}

TEST(HeadPose, motion_in_the_head_is_free_of_the_heads_own_and_in_mm) {
    auto face = mean_face_points68_mm();
    const auto rest = turned(0, 0, 0, {0, 0, 600});
    const FittedHead head(seen(face, rest), known_on_curves(), width, height);
    const auto before = face[57];
    face[57] += geometry::Point(0, -9, 0);  // the lower lip falls by 9 mm while the head turns
    const auto points = seen(face, turned(-10 * degree, 5 * degree, 0, {12, 4, 580}));
    const auto pose = head.pose(points, rest);
    ASSERT_TRUE(pose);
    const auto at = head.head_point_mm(57, points[57], *pose);
    // The pose comes of seven points: a twentieth of a degree is left of the turn, 0.1 mm at the lip, and some of the
    // distance, 3 % of the motion.
    EXPECT_NEAR(at.y() - before.y(), -9, 0.4);
    EXPECT_NEAR(at.x() - before.x(), 0, 0.4);
}

TEST(HeadPose, the_performers_size_is_that_of_the_eyes_that_is_given) {
    const auto points = seen(mean_face_points68_mm(), turned(0, 0, 0, {0, 0, 600}));
    CameraOptions options;
    options.outer_eyes_mm = 2 * mean_face_outer_eyes_mm();
    const FittedHead head(points, known_on_curves(), width, height, options);
    EXPECT_NEAR((head.points_mm()[45] - head.points_mm()[36]).norm(), 2 * mean_face_outer_eyes_mm(), 0.5);
}

TEST(HeadPose, points_that_are_not_known_are_filled_from_the_head) {
    const auto rest = turned(0, 0, 0, {0, 0, 600});
    const auto truth = seen(mean_face_points68_mm(), rest);
    const FittedHead head(truth, known_on_curves(), width, height);
    auto points = truth;
    for (std::size_t k = 0; k < 68; ++k)
        if (!known_on_curves()[k]) points[k] = Pixel(-1, -1);
    head.fill(points, known_on_curves(), rest);
    for (std::size_t k = 0; k < 68; ++k) EXPECT_LT((points[k] - truth[k]).norm(), 1.0) << k;
    EXPECT_FALSE(known_on_curves()[8]);
    EXPECT_FALSE(known_on_curves()[30]);
}

TEST(HeadPose, a_camera_without_width_is_refused) {
    CameraOptions options;
    options.focal_of_width = 0;
    EXPECT_THROW(options.check(), InputError);
}

}  // namespace
}  // namespace mimik::video
