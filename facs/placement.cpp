#include "facs/placement.h"

#include "geometry/face_axes.h"

namespace mimik::facs {

const char* side_suffix(Side side) { return side == Side::right ? "_right" : "_left"; }

geometry::Point place(const Placement& placement, const geometry::Landmarks& landmarks, Side side) {
    geometry::Point position = geometry::Point::Zero();
    for (const auto& [name, weight] : placement.at) {
        const auto* mark = landmarks.find(name);
        position += weight * (mark ? mark->position_mm : landmarks.position_mm(name + side_suffix(side)));
    }
    const double unit = geometry::outer_eye_distance_mm(landmarks);
    const double away = side == Side::right ? -1.0 : 1.0;
    return position + geometry::Point(away * placement.lateral * unit, placement.up * unit, 0.0);
}

}  // namespace mimik::facs
