#include "modeling/control_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "facs/expression_zone.h"
#include "geometry/face_axes.h"

namespace mimik::modeling {

using facs::Side;
using geometry::Landmarks;
using geometry::Point;

namespace {

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

PlacedControls place_controls(const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                              const Landmarks& landmarks, const geometry::SurfaceIndex& surface,
                              const PlacedKinds& kinds) {
    PlacedControls placed;
    const double unit = geometry::outer_eye_distance_mm(landmarks);
    const auto& sampling = catalogue.sampling();
    const double apart_mm = sampling.min_separation * unit;
    const auto near = [](const std::vector<ControlPoint>& points, const Point& p,
                         double reach_mm) -> const ControlPoint* {
        for (const auto& other : points)
            if ((other.position_mm - p).norm() < reach_mm) return &other;
        return nullptr;
    };

    const auto units = catalogue.units(expression);
    for (const auto& sided : units)
        for (const auto& point : sided.unit->points)
            for (const auto side : facs::sides_of(sided)) {
                const bool midline = facs::on_midline(point.placement);
                if (midline && side == Side::right && sided.side == Side::both) continue;
                const auto name =
                    fmt::format("AU{}.{}{}", sided.unit->number, point.name, midline ? "" : facs::side_suffix(side));
                if (const auto missing = facs::missing_marks(point.placement, landmarks, side); !missing.empty()) {
                    placed.left_out.push_back(fmt::format("{}: landmark '{}' is missing", name, missing.front()));
                    continue;
                }
                ControlPoint control{name, point.kind, facs::place(point.placement, landmarks, side)};
                if (!drop_on_surface(surface, control.position_mm)) {
                    placed.left_out.push_back(control.name + ": off the face");
                } else if (const auto* other = near(placed.controls, control.position_mm, 0.3 * apart_mm)) {
                    placed.left_out.push_back(control.name + ": on top of " + other->name);
                } else {
                    placed.controls.push_back(std::move(control));
                }
            }

    if (!kinds.coverage && !kinds.anchors) return placed;
    const facs::ExpressionZone zone(catalogue, expression, landmarks);
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
                placed.controls.push_back({fmt::format("coverage_{}_{}", row, col), facs::ControlKind::coverage, p});
        });
        if (!zone.whole_face() && 2 * off_the_face > in_zone)
            placed.left_out.push_back(
                fmt::format("{} of {} no surface", off_the_face,
                            base::counted(in_zone, "coverage point meets", "coverage points meet")));
    }
    // The anchors' lattice reaches beyond every face, too: what meets none is no loss worth a word.
    if (kinds.anchors)
        hexagonal_lattice(origin, sampling.anchor_spacing * unit, reach_mm, [&](int row, int col, Point p) {
            if (zone.distance(p) < sampling.anchor_margin || !drop_on_surface(surface, p)) return;
            placed.anchors.push_back({fmt::format("anchor_{}_{}", row, col), facs::ControlKind::anchor, p});
        });
    return placed;
}

}  // namespace mimik::modeling
