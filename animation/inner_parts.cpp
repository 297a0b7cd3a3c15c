#include "animation/inner_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/face_axes.h"
#include "geometry/point_index.h"
#include "geometry/statistics.h"
#include "geometry/topology.h"
#include "geometry/weld.h"

namespace mimik::animation {

using geometry::Landmarks;
using geometry::Point;
using geometry::Vector;

namespace {

/// Each part in ascending order.
std::vector<std::vector<std::uint32_t>> vertices_of_parts(std::span<const std::uint32_t> part_of) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_part;
    for (std::uint32_t v = 0; v < part_of.size(); ++v)
        if (part_of[v] != geometry::not_welded) by_part[part_of[v]].push_back(v);
    std::vector<std::vector<std::uint32_t>> parts;
    parts.reserve(by_part.size());
    for (auto& [part, vertices] : by_part) parts.push_back(std::move(vertices));
    return parts;
}

/// Where eyes and mouth of a face are, average frame.
struct Places {
    Point eyes[2], mouth;
    double eye_width_mm = 0.0, mouth_width_mm = 0.0;
    explicit Places(const Landmarks& landmarks) {
        const auto middle = [&](const char* a, const char* b) -> Point {
            return (landmarks.position_mm(a) + landmarks.position_mm(b)) / 2;
        };
        eyes[0] = middle("eye_outer_left", "eye_inner_left");
        eyes[1] = middle("eye_outer_right", "eye_inner_right");
        mouth = middle("mouth_corner_left", "mouth_corner_right");
        eye_width_mm = (landmarks.position_mm("eye_outer_left") - landmarks.position_mm("eye_inner_left")).norm();
        mouth_width_mm = geometry::mouth_width_mm(landmarks);
    }
    [[nodiscard]] bool is_eye(const Point& p) const {
        return std::min((p - eyes[0]).head<2>().norm(), (p - eyes[1]).head<2>().norm()) < 0.6 * eye_width_mm;
    }
    [[nodiscard]] bool is_in_mouth(const Point& p) const {
        return std::abs(p.x() - mouth.x()) < 0.7 * mouth_width_mm && std::abs(p.y() - mouth.y()) < 0.6 * mouth_width_mm;
    }
};

bool has_places(const Landmarks& landmarks) {
    return std::ranges::all_of(std::array{"nose_tip", "eye_outer_left", "eye_inner_left", "eye_outer_right",
                                          "eye_inner_right", "mouth_corner_left", "mouth_corner_right"},
                               [&](const char* name) { return landmarks.find(name) != nullptr; });
}

/// 0 above the line where the lips meet, 1 below it.
double below_lips(double above_mm) {
    constexpr double blend_mm = 3.0;
    const double t = std::clamp(0.5 - above_mm / (2 * blend_mm), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

InnerParts find_inner_parts(std::span<const Point> vertices_mm, std::span<const geometry::Triangle> triangles,
                            const Landmarks& landmarks, std::span<const double> behind_mm) {
    constexpr double skin_mm = 2.0;  // lashes, brows and beards lie on the skin
    InnerParts found{std::vector<double>(vertices_mm.size(), 0.0), std::vector<double>(vertices_mm.size(), 0.0)};
    const auto part_of = geometry::connected_parts(vertices_mm, triangles);
    const auto parts = vertices_of_parts(part_of);
    if (parts.size() < 2 || !has_places(landmarks)) return found;
    const Places places(landmarks);
    const auto nose = geometry::nearest_point(vertices_mm, landmarks.position_mm("nose_tip"),
                                              [&](std::size_t v) { return part_of[v] != geometry::not_welded; });
    for (const auto& part : parts) {
        if (std::binary_search(part.begin(), part.end(), static_cast<std::uint32_t>(nose.value_or(0)))) continue;
        std::vector<double> behind;
        Point centre = Point::Zero();
        for (const auto v : part) {
            behind.push_back(behind_mm[v]);
            centre += vertices_mm[v] / static_cast<double>(part.size());
        }
        if (geometry::median(behind) < skin_mm) continue;
        const bool eye = places.is_eye(centre), mouth = !eye && places.is_in_mouth(centre);
        if (!eye && !mouth) continue;
        (eye ? found.eye_vertices : found.mouth_vertices) += part.size();
        // A tooth turns as a whole; gums that hold both rows are parted at the lips.
        std::size_t low = 0;
        for (const auto v : part) low += vertices_mm[v].y() < places.mouth.y() ? 1 : 0;
        const double share = static_cast<double>(low) / static_cast<double>(part.size());
        const bool whole = share < 0.2 || share > 0.8;
        for (const auto v : part) {
            found.inside[v] = 1.0;
            if (mouth) found.on_jaw[v] = whole ? std::round(share) : below_lips(vertices_mm[v].y() - places.mouth.y());
        }
    }
    return found;
}

geometry::Transform jaw_turn(const Landmarks& landmarks, const Vector& chin_motion_mm) {
    // The joints lie before the ears: behind and below the outer eye corners, by shares of their distance.
    constexpr double behind = 0.6, below = 0.35;
    const auto* chin = landmarks.find("chin");
    if (!chin) return geometry::Transform::Identity();
    const double eyes_mm = geometry::outer_eye_distance_mm(landmarks);
    const Point corners = (landmarks.position_mm("eye_outer_left") + landmarks.position_mm("eye_outer_right")) / 2;
    const Point joint = corners - Vector(0, below * eyes_mm, behind * eyes_mm);
    const Vector from = chin->position_mm - joint, to = from + chin_motion_mm;
    // About +x, which takes +y to +z and so the chin, which lies before the joints, down and back.
    const double angle = std::max(0.0, std::atan2(to.z(), to.y()) - std::atan2(from.z(), from.y()));
    return geometry::Transform(Eigen::Translation3d(joint) * Eigen::AngleAxisd(angle, Vector::UnitX()) *
                               Eigen::Translation3d(-joint));
}

}  // namespace mimik::animation
