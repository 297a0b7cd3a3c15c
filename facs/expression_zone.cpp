#include "facs/expression_zone.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/face_axes.h"

namespace mimik::facs {

std::vector<Side> sides_of(const SidedUnit& sided) {
    if (sided.side == Side::both) return {Side::left, Side::right};
    return {sided.side};
}

ExpressionZone::ExpressionZone(const FacsCatalogue& catalogue, const Expression& expression,
                               const geometry::Landmarks& landmarks)
    : unit_mm_(geometry::outer_eye_distance_mm(landmarks)) {
    const auto units = catalogue.units(expression);
    whole_face_ = units.empty();
    for (const auto& sided : units)
        for (const auto side : sides_of(sided))
            for (const auto& ellipse : sided.unit->zone) {
                const geometry::Point centre = place(ellipse.centre, landmarks, side);
                ellipses_.push_back(
                    {centre.x(), centre.y(), ellipse.lateral_radius * unit_mm_, ellipse.up_radius * unit_mm_});
            }
}

double ExpressionZone::distance(const geometry::Point& position_mm) const {
    if (whole_face_) return -1.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& e : ellipses_) {
        const double dx = (position_mm.x() - e.x) / e.rx, dy = (position_mm.y() - e.y) / e.ry;
        // Along the ray from the centre: exact on the ellipse and its axes, a fair measure elsewhere.
        const double radius = std::hypot(dx, dy);
        const double length = std::hypot(position_mm.x() - e.x, position_mm.y() - e.y);
        nearest = std::min(nearest, radius > 0 ? length * (1.0 - 1.0 / radius) : -std::min(e.rx, e.ry));
    }
    return nearest / unit_mm_;
}

}  // namespace mimik::facs
