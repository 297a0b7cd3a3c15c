#include "geometry/landmark_spline.h"

#include <algorithm>
#include <string>
#include <vector>

namespace mimik::geometry {

ThinPlateSpline landmark_spline(const Landmarks& source, const Landmarks& target,
                                const ThinPlateSplineOptions& options) {
    constexpr double same_point_mm = 1e-6;
    std::vector<Point> from, to;
    std::vector<double> count;
    std::vector<std::string> names;
    for (const auto& pair : pair_by_name(source, target).pairs) {
        const auto same = std::find_if(from.begin(), from.end(),
                                       [&](const Point& p) { return (p - pair.source_mm).norm() < same_point_mm; });
        if (same != from.end()) {
            const auto k = static_cast<std::size_t>(same - from.begin());
            to[k] = (count[k] * to[k] + pair.target_mm) / (count[k] + 1);
            ++count[k];
            names[k] += " and " + pair.name;
            continue;
        }
        from.push_back(pair.source_mm);
        to.push_back(pair.target_mm);
        count.push_back(1);
        names.push_back(pair.name);
    }
    return ThinPlateSpline::fit(from, to, options, names);
}

}  // namespace mimik::geometry
