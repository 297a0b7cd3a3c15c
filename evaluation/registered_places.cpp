#include "evaluation/registered_places.h"

#include "geometry/surface_index.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::Vector;

SkinPlaces registered_places(const preprocessing::KeptRegistrations& registrations, const preprocessing::Face& neutral,
                             const preprocessing::Face& expressive, const geometry::Transform& neutral_from_expressive,
                             std::span<const std::uint32_t> vertices) {
    constexpr double reach_mm = 5.0;  // as of zones from the data
    const auto& registration = registrations.registration();
    const auto rest = registrations.neutral(neutral);
    // The registration that is kept is of the scans as preprocessing aligned them. This one is of its own alignment,
    // and so never kept.
    auto aligned = expressive;
    aligned.neutral_from_scan = neutral_from_expressive;
    aligned.average_from_scan = neutral.average_from_scan * neutral_from_expressive;
    const auto motion = registration.motion(neutral, rest, aligned);
    const geometry::SurfaceIndex bent(rest.vertices_mm, registration.face_template().surface.triangles);
    std::vector<Point> queries;
    queries.reserve(vertices.size());
    for (const auto v : vertices) queries.emplace_back(neutral.average_from_scan * neutral.grid.vertices_mm[v]);
    const auto hits = bent.closest(queries);
    const Eigen::Matrix3d scan_from_average = neutral.average_from_scan.linear().inverse();
    SkinPlaces places;
    for (std::size_t k = 0; k < hits.size(); ++k) {
        const auto& corners = bent.triangles()[hits[k].triangle];
        Vector way = Vector::Zero();
        double matched = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double share = hits[k].barycentric[static_cast<Eigen::Index>(c)];
            way += share * motion.motion_mm[corners[c]];
            matched += motion.matched[corners[c]] ? share : 0.0;
        }
        places.place_mm.emplace_back(neutral.grid.vertices_mm[vertices[k]] + scan_from_average * way);
        places.known.push_back(hits[k].distance_mm < reach_mm && matched >= 0.5 ? 1 : 0);
    }
    return places;
}

}  // namespace mimik::evaluation
