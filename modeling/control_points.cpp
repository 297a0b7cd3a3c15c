#include "modeling/control_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "preprocessing/workspace.h"

namespace mimik::modeling {

using database::Side;
using geometry::Landmarks;
using geometry::Point;

namespace {

double eye_distance_mm(const Landmarks& landmarks) {
    return (landmarks.position_mm("eye_outer_left") - landmarks.position_mm("eye_outer_right")).norm();
}

std::vector<Side> sides_of(const SidedUnit& sided) {
    if (sided.side == Side::both) return {Side::left, Side::right};
    return {sided.side};
}

const char* suffix(Side side) { return side == Side::right ? "_right" : "_left"; }

/// Onto the surface along the depth axis, as a scanner sees it.
bool drop_on_surface(const geometry::SurfaceIndex& surface, Point& position) {
    geometry::SurfacePoint hit;
    if (!surface.first_hit({position.x(), position.y(), position.z() + 300.0}, -geometry::Vector::UnitZ(), hit))
        return false;
    position = hit.position_mm;
    return true;
}

/// A hexagonal lattice about the face's midline: symmetric, and named by its own numbers.
template <typename Visit>
void hexagonal_lattice(const Point& origin, double spacing_mm, double reach_mm, const Visit& visit) {
    const double row_mm = spacing_mm * std::sqrt(3.0) / 2.0;
    const int rows = static_cast<int>(reach_mm / row_mm), cols = static_cast<int>(reach_mm / spacing_mm);
    for (int row = -rows; row <= rows; ++row)
        for (int col = -cols; col <= cols; ++col) {
            // Odd rows are shifted by half a step both ways, so that mirroring maps the lattice onto itself.
            const double shift =
                row % 2 != 0 ? (col < 0 ? 0.5 : (col > 0 ? -0.5 : std::numeric_limits<double>::quiet_NaN())) : 0.0;
            if (std::isnan(shift)) continue;
            visit(row, col, Point(origin.x() + (col + shift) * spacing_mm, origin.y() + row * row_mm, origin.z()));
        }
}

}  // namespace

Point place(const Placement& placement, const Landmarks& landmarks, Side side) {
    Point position = Point::Zero();
    for (const auto& [name, weight] : placement.at) {
        const auto* mark = landmarks.find(name);
        position += weight * (mark ? mark->position_mm : landmarks.position_mm(name + suffix(side)));
    }
    const double unit = eye_distance_mm(landmarks);
    const double away = side == Side::right ? -1.0 : 1.0;
    return position + Point(away * placement.lateral * unit, placement.up * unit, 0.0);
}

ExpressionZone::ExpressionZone(const FacsCatalogue& catalogue, const std::string& expression,
                               const Landmarks& landmarks)
    : unit_mm_(eye_distance_mm(landmarks)) {
    for (const auto& sided : catalogue.resolve(expression))
        for (const auto side : sides_of(sided))
            for (const auto& ellipse : sided.unit->zone) {
                const Point centre = place(ellipse.centre, landmarks, side);
                ellipses_.push_back(
                    {centre.x(), centre.y(), ellipse.lateral_radius * unit_mm_, ellipse.up_radius * unit_mm_});
            }
}

double ExpressionZone::distance(const Point& position_mm) const {
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

PlacedControls place_controls(const FacsCatalogue& catalogue, const std::string& expression, const Landmarks& landmarks,
                              const geometry::SurfaceIndex& surface, const PlacedKinds& kinds) {
    PlacedControls placed;
    const double unit = eye_distance_mm(landmarks);
    const auto& sampling = catalogue.sampling();
    const double apart_mm = sampling.min_separation * unit;
    const auto near = [](const std::vector<ControlPoint>& points, const Point& p,
                         double reach_mm) -> const ControlPoint* {
        for (const auto& other : points)
            if ((other.position_mm - p).norm() < reach_mm) return &other;
        return nullptr;
    };

    const auto units = catalogue.resolve(expression);
    for (const auto& sided : units)
        for (const auto& point : sided.unit->points)
            for (const auto side : sides_of(sided)) {
                const bool midline =
                    std::all_of(point.placement.at.begin(), point.placement.at.end(),
                                [&](const auto& term) { return landmarks.find(term.first) != nullptr; }) &&
                    point.placement.lateral == 0.0;
                if (midline && side == Side::right && sided.side == Side::both) continue;
                ControlPoint control{
                    fmt::format("AU{}.{}{}", sided.unit->number, point.name, midline ? "" : suffix(side)), point.kind,
                    place(point.placement, landmarks, side)};
                if (!drop_on_surface(surface, control.position_mm)) {
                    placed.left_out.push_back(control.name + ": off the face");
                } else if (const auto* other = near(placed.controls, control.position_mm, 0.3 * apart_mm)) {
                    placed.left_out.push_back(control.name + ": on top of " + other->name);
                } else {
                    placed.controls.push_back(std::move(control));
                }
            }

    const ExpressionZone zone(catalogue, expression, landmarks);
    const Point origin = landmarks.position_mm("nose_tip");
    const double reach_mm = 2.2 * unit;
    if (kinds.coverage) {
        std::size_t in_zone = 0, off_the_face = 0;
        hexagonal_lattice(origin, sampling.coverage_spacing * unit, reach_mm, [&](int row, int col, Point p) {
            if (zone.distance(p) > 0) return;
            ++in_zone;
            if (!drop_on_surface(surface, p))
                ++off_the_face;
            else if (!near(placed.controls, p, apart_mm))
                placed.controls.push_back({fmt::format("coverage_{}_{}", row, col), ControlKind::coverage, p});
        });
        if (2 * off_the_face > in_zone)
            placed.left_out.push_back(fmt::format("{} of {} coverage points meet no surface", off_the_face, in_zone));
    }
    // The anchors' lattice reaches beyond every face, too: what meets none is no loss worth a word.
    if (kinds.anchors)
        hexagonal_lattice(origin, sampling.anchor_spacing * unit, reach_mm, [&](int row, int col, Point p) {
            if (zone.distance(p) < sampling.anchor_margin || !drop_on_surface(surface, p)) return;
            placed.anchors.push_back({fmt::format("anchor_{}_{}", row, col), ControlKind::anchor, p});
        });
    return placed;
}

std::vector<char> stable_vertices(const FacsCatalogue& catalogue, const std::string& expression,
                                  const preprocessing::Face& neutral) {
    const auto& grid = neutral.grid;
    const ExpressionZone zone(catalogue, expression,
                              geometry::transformed(neutral.landmarks, neutral.average_from_scan));
    const double margin = catalogue.sampling().anchor_margin;
    std::vector<char> stable(grid.size(), 0);
    std::size_t measured = 0, count = 0;
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.measured(v)) continue;
        ++measured;
        stable[v] = zone.distance(neutral.average_from_scan * grid.vertices_mm[v]) > margin ? 1 : 0;
        count += static_cast<std::size_t>(stable[v]);
    }
    return 10 * count >= measured ? stable : preprocessing::stable_on_every_face(neutral);
}

}  // namespace mimik::modeling
