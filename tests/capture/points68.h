#pragma once

#include <array>
#include <cmath>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

// A face of 68 points, and tables of it as other programs write them.

namespace mimik::test {

using Face68 = std::array<Eigen::Vector3d, 68>;

/// In the head's frame, mm, the outer eye corners 88 mm apart about the origin; not a handsome one.
inline Face68 face68_mm() {
    Face68 face;
    for (int k = 0; k < 68; ++k) {
        const double angle = 0.37 * k;
        face[static_cast<std::size_t>(k)] = {30 * std::cos(angle), -40 + 25 * std::sin(angle), 5 * std::cos(3 * angle)};
    }
    face[36] = {-44, 0, 0};
    face[39] = {-16, 1, 4};
    face[42] = {16, 1, 4};
    face[45] = {44, 0, 0};
    for (std::size_t k = 27; k < 31; ++k) face[k] = {0, -10.0 * (static_cast<double>(k) - 26), 12};
    face[31] = {-15, -45, 5};
    face[33] = {0, -48, 8};
    face[35] = {15, -45, 5};
    face[48] = {-25, -75, 0};
    face[54] = {25, -75, 0};
    face[57] = {0, -85, 4};
    return face;
}

using Pixels68 = std::array<Eigen::Vector2d, 68>;

/// As a camera far away sees it: rolled about `at`, so many pixels a millimetre, v down.
inline Pixels68 pixels68(const Face68& face, const Eigen::Vector2d& at, double roll_rad, double pixels_per_mm) {
    Pixels68 pixels;
    const Eigen::Rotation2Dd roll(roll_rad);
    for (std::size_t k = 0; k < 68; ++k)
        pixels[k] = at + pixels_per_mm * (roll * Eigen::Vector2d(face[k].x(), -face[k].y()));
    return pixels;
}

inline std::string header68() {
    std::string text = "frame,detected";
    for (int k = 0; k < 68; ++k) text += fmt::format(",x{},y{}", k, k);
    return text + "\n";
}
inline std::string row68(int frame, const Pixels68& pixels) {
    auto text = fmt::format("{},1", frame);
    for (const auto& p : pixels) text += fmt::format(",{},{}", p.x(), p.y());
    return text + "\n";
}

/// x to the right of the image, y down, z away: OpenFace's face looks at the camera.
inline Eigen::Vector3d openface_camera(const Eigen::Vector3d& head_mm, const Eigen::Vector3d& angles_rad,
                                       const Eigen::Vector3d& place_mm) {
    const Eigen::Vector3d own(head_mm.x(), -head_mm.y(), -head_mm.z());
    return Eigen::AngleAxisd(angles_rad.x(), Eigen::Vector3d::UnitX()) *
               (Eigen::AngleAxisd(angles_rad.y(), Eigen::Vector3d::UnitY()) *
                (Eigen::AngleAxisd(angles_rad.z(), Eigen::Vector3d::UnitZ()) * own)) +
           place_mm;
}
inline std::string openface_header() {
    std::string text =
        "frame, face_id, timestamp, confidence, success, pose_Tx, pose_Ty, pose_Tz, pose_Rx, pose_Ry, pose_Rz";
    for (const auto* axis : {"x", "y", "X", "Y", "Z"})
        for (int k = 0; k < 68; ++k) text += fmt::format(", {}_{}", axis, k);
    return text + "\n";
}
inline std::string openface_row(int frame, double time_s, const Face68& face, const Eigen::Vector3d& angles_rad,
                                const Eigen::Vector3d& place_mm, int face_id = 0) {
    auto text = fmt::format("{}, {}, {:.3f}, 0.98, 1", frame, face_id, time_s);
    for (const double value : place_mm) text += fmt::format(", {:.6f}", value);
    for (const double value : angles_rad) text += fmt::format(", {:.6f}", value);
    Face68 camera;
    for (std::size_t k = 0; k < 68; ++k) camera[k] = openface_camera(face[k], angles_rad, place_mm);
    for (const int axis : {0, 1})  // 500 pixels of focal length
        for (const auto& p : camera) text += fmt::format(", {:.6f}", 320 + 500 * p[axis] / p.z());
    for (const int axis : {0, 1, 2})
        for (const auto& p : camera) text += fmt::format(", {:.6f}", p[axis]);
    return text + "\n";
}

}  // namespace mimik::test
