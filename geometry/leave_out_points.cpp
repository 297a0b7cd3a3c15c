#include "geometry/leave_out_points.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace mimik::geometry {

RangeScan leave_out_points(const RangeScan& scan, const VertexMask& left_out) {
    RangeScan rest = scan;
    const std::size_t n = scan.points_mm.size();
    const Point nothing = Point::Constant(std::numeric_limits<double>::quiet_NaN());
    if (scan.organised()) {
        for (std::size_t i = 0; i < n; ++i)
            if (left_out[i]) rest.points_mm[i] = nothing;
        return rest;
    }
    rest.points_mm.clear();
    rest.texture_coordinates.clear();
    rest.faces = {};
    constexpr auto nowhere = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> place(n, nowhere);
    for (std::size_t i = 0; i < n; ++i)
        if (!left_out[i] && scan.valid(i)) {
            place[i] = static_cast<std::uint32_t>(rest.points_mm.size());
            rest.points_mm.push_back(scan.points_mm[i]);
            if (!scan.texture_coordinates.empty()) rest.texture_coordinates.push_back(scan.texture_coordinates[i]);
        }
    for (std::size_t f = 0; f < scan.faces.size(); ++f) {
        std::vector<std::uint32_t> corners;
        for (const auto v : scan.faces[f]) corners.push_back(place[v]);
        if (std::find(corners.begin(), corners.end(), nowhere) == corners.end()) rest.faces.add(corners);
    }
    return rest;
}

}  // namespace mimik::geometry
