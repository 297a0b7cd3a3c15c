#include "evaluation/data_zone.h"

#include "geometry/surface_index.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::Vector;

MotionOnAverage::MotionOnAverage(const preprocessing::AverageFace& average,
                                 const preprocessing::FaceTemplate& face_template)
    : size_(average.grid.size()) {
    constexpr double reach_mm = 5.0;  // the template has vertices 2 mm apart, and ends where the average face does
    std::vector<Point> queries;
    for (std::size_t v = 0; v < size_; ++v) {
        if (!average.grid.inside(v)) continue;
        places_.emplace_back().vertex = v;
        queries.push_back(average.grid.vertices_mm[v]);
    }
    const auto& surface = face_template.surface;
    const auto hits = geometry::SurfaceIndex(surface.vertices_mm, surface.triangles).closest(queries);
    for (std::size_t k = 0; k < hits.size(); ++k) {
        places_[k].corners = surface.triangles[hits[k].triangle];
        if (hits[k].distance_mm < reach_mm) places_[k].weights = hits[k].barycentric;
    }
}

std::vector<Vector> MotionOnAverage::of(std::span<const Vector> motion_mm) const {
    std::vector<Vector> motion(size_, Vector::Zero());
    for (const auto& place : places_)
        for (std::size_t c = 0; c < 3; ++c)
            motion[place.vertex] += place.weights[static_cast<Eigen::Index>(c)] * motion_mm[place.corners[c]];
    return motion;
}

}  // namespace mimik::evaluation
