#include "video/head_pose.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "base/errors.h"

namespace mimik::video {
namespace {

/// Corners of the eyes, wings and base of the nose.
constexpr std::array<std::size_t, 7> stable = {36, 39, 42, 45, 31, 33, 35};

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector) {
    const double angle = vector.norm();
    return angle > 0 ? Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
}

/// A face that looks into the camera.
capture::HeadPose frontal(double distance_mm) {
    return {Eigen::Vector3d(EIGEN_PI, 0, 0), Eigen::Vector3d(0, 0, distance_mm)};
}

std::optional<capture::HeadPose> solve(const std::vector<cv::Point3d>& head_mm, const std::vector<cv::Point2d>& pixels,
                                       double focal_px, double centre_x, double centre_y,
                                       const capture::HeadPose& start) {
    const cv::Matx33d camera(focal_px, 0, centre_x, 0, focal_px, centre_y, 0, 0, 1);
    cv::Vec3d turn(start.rotation_vector[0], start.rotation_vector[1], start.rotation_vector[2]);
    cv::Vec3d shift(start.translation_mm[0], start.translation_mm[1], start.translation_mm[2]);
    try {
        if (!cv::solvePnP(head_mm, pixels, camera, cv::noArray(), turn, shift, true, cv::SOLVEPNP_ITERATIVE))
            return std::nullopt;
    } catch (const cv::Exception&) {
        return std::nullopt;
    }
    capture::HeadPose pose{{turn[0], turn[1], turn[2]}, {shift[0], shift[1], shift[2]}};
    if (!pose.rotation_vector.allFinite() || !pose.translation_mm.allFinite() || pose.translation_mm.z() < 50)
        return std::nullopt;
    return pose;
}

}  // namespace

void CameraOptions::check() const {
    if (!(focal_of_width > 0.2 && focal_of_width < 20))
        throw InputError(fmt::format("focal_of_width is {}; give 0.2 to 20", focal_of_width));
    if (outer_eyes_mm && !(*outer_eyes_mm > 20 && *outer_eyes_mm < 300))
        throw InputError(fmt::format("outer_eyes_mm is {}; give 20 to 300", *outer_eyes_mm));
}

const Known68& known_on_curves() {
    static const Known68 known = [] {
        Known68 made{};
        for (const auto& place : places_on_curves()) made[static_cast<std::size_t>(place.point)] = true;
        return made;
    }();
    return known;
}

FittedHead::FittedHead(const Points68& neutral, const Known68& known, int image_width, int image_height,
                       const CameraOptions& options)
    : points_mm_(mean_face_points68_mm()),
      focal_px_(options.focal_of_width * image_width),
      centre_x_(0.5 * (image_width - 1)),
      centre_y_(0.5 * (image_height - 1)) {
    options.check();
    const double size = options.outer_eyes_mm.value_or(mean_face_outer_eyes_mm()) / mean_face_outer_eyes_mm();
    for (auto& p : points_mm_) p *= size;
    // A performer at rest looks into the camera: from points whose depth nobody knows, a turn could not be told from
    // another face. The tilt is seen.
    const Pixel across = neutral[45] - neutral[36], middle_px = 0.5 * (neutral[36] + neutral[45]);
    const double distance_mm = focal_px_ * size * mean_face_outer_eyes_mm() / std::max(1.0, across.norm());
    const Eigen::AngleAxisd turn(Eigen::AngleAxisd(std::atan2(across.y(), across.x()), Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitX()));
    const capture::HeadPose pose{turn.angle() * turn.axis(),
                                 distance_mm * Eigen::Vector3d((middle_px.x() - centre_x_) / focal_px_,
                                                               (middle_px.y() - centre_y_) / focal_px_, 1)};
    // The known points go to their rays. What of the others is width and height follows them.
    Eigen::Vector2d own = Eigen::Vector2d::Zero(), mean = own;
    const auto before = points_mm_;
    for (std::size_t k = 0; k < 68; ++k) {
        if (!known[k]) continue;
        points_mm_[k] = head_point_mm(k, neutral[k], pose);
        for (int axis = 0; axis < 2; ++axis) {
            own[axis] += points_mm_[k][axis] * before[k][axis];
            mean[axis] += before[k][axis] * before[k][axis];
        }
    }
    for (std::size_t k = 0; k < 68; ++k)
        for (int axis = 0; axis < 2 && !known[k]; ++axis)
            points_mm_[k][axis] *= std::clamp(own[axis] / mean[axis], 0.7, 1.4);
    // The origin stays in the middle between the outer eye corners.
    const geometry::Point middle = 0.5 * (points_mm_[36] + points_mm_[45]);
    for (auto& p : points_mm_) p -= middle;
}

std::optional<capture::HeadPose> FittedHead::pose(const Points68& points,
                                                  const std::optional<capture::HeadPose>& start) const {
    std::vector<cv::Point3d> head;
    std::vector<cv::Point2d> pixels;
    for (const auto k : stable) {
        head.emplace_back(points_mm_[k].x(), points_mm_[k].y(), points_mm_[k].z());
        pixels.emplace_back(points[k].x(), points[k].y());
    }
    const double eyes_px = std::max(1.0, (points[45] - points[36]).norm());
    const double distance_mm = focal_px_ * (points_mm_[45] - points_mm_[36]).norm() / eyes_px;
    return solve(head, pixels, focal_px_, centre_x_, centre_y_, start.value_or(frontal(distance_mm)));
}

Pixel FittedHead::project(const geometry::Point& head_mm, const capture::HeadPose& pose) const {
    const Eigen::Vector3d p = rotation_of(pose.rotation_vector) * head_mm + pose.translation_mm;
    return {focal_px_ * p.x() / p.z() + centre_x_, focal_px_ * p.y() / p.z() + centre_y_};
}

geometry::Point FittedHead::head_point_mm(std::size_t k, const Pixel& at, const capture::HeadPose& pose) const {
    const Eigen::Matrix3d back = rotation_of(pose.rotation_vector).transpose();
    const Eigen::Vector3d from = -back * pose.translation_mm;
    const Eigen::Vector3d way =
        back * Eigen::Vector3d((at.x() - centre_x_) / focal_px_, (at.y() - centre_y_) / focal_px_, 1);
    return from + (points_mm_[k].z() - from.z()) / way.z() * way;
}

void FittedHead::fill(Points68& points, const Known68& known, const capture::HeadPose& pose) const {
    const double drop_mm = std::min(0.0, head_point_mm(57, points[57], pose).y() - points_mm_[57].y());
    for (std::size_t k = 0; k < 68; ++k) {
        if (known[k]) continue;
        auto at = points_mm_[k];
        if (k < 17) at.y() += drop_mm * std::max(0.0, 1 - std::abs(static_cast<double>(k) - 8) / 6);
        points[k] = project(at, pose);
    }
}

}  // namespace mimik::video
