#include "preprocessing/nearest_on_average.h"

#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/landmark_spline.h"
#include "geometry/point_index.h"

namespace mimik::preprocessing {

using geometry::Point;

std::string without_partner(const Face& face, const AverageFace& average) {
    const geometry::LandmarkPairs pairs(face.landmarks, average.landmarks);
    std::vector<std::string> parts;
    if (const auto names = pairs.only_in_to(); !names.empty())
        parts.push_back(fmt::format("the scan lacks {} of the average face", fmt::join(names, ", ")));
    if (const auto names = pairs.only_in_from(); !names.empty())
        parts.push_back(fmt::format("the average face lacks {} of the scan", fmt::join(names, ", ")));
    if (parts.empty()) return {};
    return fmt::format("landmarks without a partner: {}; what is learned between the two goes without them",
                       fmt::join(parts, "; "));
}

std::vector<NearestOnAverage> nearest_on_average(const Face& face, const AverageFace& average) {
    std::vector<Point> known;
    std::vector<std::size_t> place;
    for (std::size_t v = 0; v < average.grid.size(); ++v)
        if (average.grid.inside(v)) {
            known.push_back(average.grid.vertices_mm[v]);
            place.push_back(v);
        }
    std::vector<Point> vertices;
    for (std::size_t v = 0; v < face.grid.size(); ++v)
        vertices.push_back(face.grid.inside(v) ? face.grid.vertices_mm[v] : Point(Point::Zero()));
    geometry::landmark_spline(face.landmarks, average.landmarks).apply(vertices, vertices);
    const auto nearest = geometry::PointIndex(known).nearest(vertices);
    std::vector<NearestOnAverage> found;
    for (std::size_t v = 0; v < nearest.size(); ++v)
        found.push_back({place[nearest[v].index],
                         face.grid.inside(v) ? nearest[v].distance_mm : std::numeric_limits<double>::infinity()});
    return found;
}

}  // namespace mimik::preprocessing
