#include "report/surface_profile.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/surface_index.h"

namespace mimik::report {

std::vector<ProfilePoint> surface_profile(const geometry::Mesh& mesh, const CutLine& line) {
    const double dx = line.to_mm[0] - line.from_mm[0], dy = line.to_mm[1] - line.from_mm[1];
    const double length_mm = std::hypot(dx, dy);
    if (line.samples < 2 || !(length_mm > 0))
        throw InputError(
            fmt::format("a cut of {} samples and {} mm; give 2 or more and a length", line.samples, length_mm));
    const geometry::SurfaceIndex surface(mesh.vertices_mm, geometry::triangulate(mesh.faces));
    double front_mm = -std::numeric_limits<double>::infinity();
    for (const auto& p : mesh.vertices_mm) front_mm = std::max(front_mm, p.z());
    std::vector<ProfilePoint> profile;
    for (int k = 0; k < line.samples; ++k) {
        const double share = static_cast<double>(k) / (line.samples - 1);
        const geometry::Point eye(line.from_mm[0] + share * dx, line.from_mm[1] + share * dy, front_mm + 1);
        geometry::SurfacePoint hit;
        const bool met = surface.first_hit(eye, -geometry::Vector::UnitZ(), hit);
        profile.push_back({share * length_mm, met ? hit.position_mm.z() : std::numeric_limits<double>::quiet_NaN()});
    }
    return profile;
}

}  // namespace mimik::report
