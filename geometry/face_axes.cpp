#include "geometry/face_axes.h"

#include <initializer_list>
#include <string_view>

namespace mimik::geometry {

double outer_eye_distance_mm(const Landmarks& landmarks) {
    return (landmarks.position_mm("eye_outer_left") - landmarks.position_mm("eye_outer_right")).norm();
}

double mouth_width_mm(const Landmarks& landmarks) {
    return (landmarks.position_mm("mouth_corner_left") - landmarks.position_mm("mouth_corner_right")).norm();
}

std::optional<HeadAxes> head_axes(const Landmarks& marks) {
    const auto mean = [&](std::initializer_list<std::string_view> names) -> std::optional<Point> {
        Point sum = Point::Zero();
        for (const auto name : names) {
            const auto* mark = marks.find(name);
            if (!mark) return std::nullopt;
            sum += mark->position_mm;
        }
        return sum / static_cast<double>(names.size());
    };
    const auto eyes = mean({"eye_outer_left", "eye_outer_right", "eye_inner_left", "eye_inner_right"});
    const auto mouth = mean({"mouth_corner_left", "mouth_corner_right"});
    const auto nose = mean({"nose_tip"});
    const auto left = mean({"eye_outer_left", "eye_inner_left", "mouth_corner_left"});
    const auto right = mean({"eye_outer_right", "eye_inner_right", "mouth_corner_right"});
    if (!eyes || !mouth || !nose || !left || !right) return std::nullopt;
    HeadAxes axes;
    axes.lateral = (*left - *right).normalized();
    axes.up = *eyes - *mouth;
    axes.up = (axes.up - axes.lateral * axes.lateral.dot(axes.up)).normalized();
    // The nose tip stands before the plane of eyes and mouth corners whatever the names are.
    Vector out = *nose - (*eyes + *mouth) / 2;
    out -= axes.lateral * axes.lateral.dot(out);
    axes.out = (out - axes.up * axes.up.dot(out)).normalized();
    if (!axes.lateral.allFinite() || !axes.up.allFinite() || !axes.out.allFinite()) return std::nullopt;
    return axes;
}

}  // namespace mimik::geometry
