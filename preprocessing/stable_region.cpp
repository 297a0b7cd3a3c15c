#include "preprocessing/stable_region.h"

#include <cmath>

#include "facs/expression_zone.h"
#include "geometry/face_axes.h"

namespace mimik::preprocessing {

using geometry::Point;

geometry::VertexMask stable_on_every_face(const Face& neutral) {
    const auto marks = geometry::transformed(neutral.landmarks, neutral.average_from_scan);
    const Point &left = marks.position_mm("eye_outer_left"), &right = marks.position_mm("eye_outer_right");
    const Point middle = 0.5 * (left + right);
    const double eyes_mm = geometry::outer_eye_distance_mm(marks);
    geometry::VertexMask stable(neutral.grid.size(), 0);
    for (std::size_t v = 0; v < stable.size(); ++v) {
        if (!neutral.grid.measured(v)) continue;
        const Point p = neutral.average_from_scan * neutral.grid.vertices_mm[v];
        const double x = std::abs(p.x() - middle.x()) / eyes_mm, y = (p.y() - middle.y()) / eyes_mm;
        const bool nose_bridge = x < 0.22 && y > -0.30 && y < 0.10;
        const bool temple = x > 0.50 && x < 0.75 && y > -0.15 && y < 0.40;
        stable[v] = nose_bridge || temple ? 1 : 0;
    }
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
    return 10 * count >= measured ? stable : stable_on_every_face(neutral);
}

}  // namespace mimik::preprocessing
