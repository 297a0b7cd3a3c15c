#include "preprocessing/stable_region.h"

#include <cmath>

#include "facs/expression_zone.h"
#include "geometry/face_axes.h"

namespace mimik::preprocessing {

using geometry::Point;

namespace {

/// Measured vertices of a neutral face, upright: x to each side of the middle between the outer eye corners and y above
/// it, in outer-eye distances.
template <typename Visit>
void visit_upright(const Face& neutral, const Visit& visit) {
    const auto marks = geometry::transformed(neutral.landmarks, neutral.average_from_scan);
    const Point middle = 0.5 * (marks.position_mm("eye_outer_left") + marks.position_mm("eye_outer_right"));
    const double eyes_mm = geometry::outer_eye_distance_mm(marks);
    for (std::size_t v = 0; v < neutral.grid.size(); ++v) {
        if (!neutral.grid.measured(v)) continue;
        const Point p = neutral.average_from_scan * neutral.grid.vertices_mm[v];
        visit(v, std::abs(p.x() - middle.x()) / eyes_mm, (p.y() - middle.y()) / eyes_mm);
    }
}

/// What moves least where an emotion moves nearly all. Brows take the temples and the root of the nose along.
void add_nose_and_cheeks(geometry::VertexMask& stable, const Face& neutral) {
    visit_upright(neutral, [&](std::size_t v, double x, double y) {
        const bool nose = x < 0.22;
        const bool before_the_ears = x > 0.6;
        if (y > -0.6 && y < 0.0 && (nose || before_the_ears)) stable[v] = 1;
    });
}

}  // namespace

geometry::VertexMask stable_on_every_face(const Face& neutral) {
    geometry::VertexMask stable(neutral.grid.size(), 0);
    visit_upright(neutral, [&](std::size_t v, double x, double y) {
        const bool nose_bridge = x < 0.22 && y > -0.30 && y < 0.10;
        const bool temple = x > 0.50 && x < 0.75 && y > -0.15 && y < 0.40;
        stable[v] = nose_bridge || temple ? 1 : 0;
    });
    return stable;
}

geometry::VertexMask stable_vertices(const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                                     const Face& neutral) {
    const auto& grid = neutral.grid;
    const facs::ExpressionZone zone(catalogue, expression,
                                    geometry::transformed(neutral.landmarks, neutral.average_from_scan));
    const double margin = catalogue.sampling().anchor_margin;
    geometry::VertexMask stable(grid.size(), 0);
    std::size_t measured = 0, count = 0;
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.measured(v)) continue;
        ++measured;
        stable[v] = zone.distance(neutral.average_from_scan * grid.vertices_mm[v]) > margin ? 1 : 0;
        count += stable[v];
    }
    if (10 * count >= measured) return stable;
    if (expression.group() != "E") return stable_on_every_face(neutral);
    add_nose_and_cheeks(stable, neutral);
    return stable;
}

}  // namespace mimik::preprocessing
