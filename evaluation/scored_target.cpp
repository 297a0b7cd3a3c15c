#include "evaluation/scored_target.h"

#include <algorithm>

#include "evaluation/over_hole.h"

namespace mimik::evaluation {

using geometry::Point;

std::size_t ScoredTarget::zone_size() const {
    return static_cast<std::size_t>(std::count_if(in_zone.begin(), in_zone.end(), [](auto in) { return in != 0; }));
}

ScoredTarget scored_target(const geometry::FaceSurface& neutral, const geometry::QuadGrid& expressive,
                           const geometry::Transform& neutral_from_expressive, const geometry::VertexMask& zone) {
    ScoredTarget target;
    std::vector<Point> surface;
    surface.reserve(expressive.size());
    for (const auto& p : expressive.vertices_mm) surface.emplace_back(neutral_from_expressive * p);
    target.expressive.emplace(surface, geometry::triangles(expressive, geometry::BridgedVertices::leave_out));
    target.hole_rim = hole_rim(expressive);

    std::vector<std::uint32_t> measured;
    std::vector<Point> queries;
    for (std::uint32_t v = 0; v < neutral.size(); ++v)
        if (neutral.measured[v]) {
            measured.push_back(v);
            queries.push_back(neutral.vertices_mm[v]);
        }
    const auto hits = target.expressive->closest(queries);
    for (std::size_t k = 0; k < measured.size(); ++k) {
        if (target.expressive->on_border(hits[k])) continue;
        target.vertices.push_back(measured[k]);
        target.in_zone.push_back(zone[measured[k]]);
        target.nothing_mm.push_back(hits[k].distance_mm);
    }
    return target;
}

}  // namespace mimik::evaluation
