#include "synthesis/depth_raster.h"

#include <algorithm>
#include <cmath>

namespace mimik::synthesis {

std::vector<RasterHit> depth_raster(std::span<const geometry::Point> vertices_mm,
                                    std::span<const geometry::Triangle> triangles, const RasterLattice& lattice) {
    std::vector<RasterHit> hits(static_cast<std::size_t>(lattice.rows) * static_cast<std::size_t>(lattice.cols));
    const double inverse = 1.0 / lattice.spacing_mm;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto &a = vertices_mm[triangles[t][0]], &b = vertices_mm[triangles[t][1]],
                   &c = vertices_mm[triangles[t][2]];
        const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
        if (std::abs(area) < 1e-12) continue;  // seen edge on
        const double per_area = 1.0 / area;
        const auto first = [&](double low, double origin) {
            return std::max(0, static_cast<int>(std::ceil((low - origin) * inverse)));
        };
        const auto last = [&](double high, double origin, int count) {
            return std::min(count - 1, static_cast<int>(std::floor((high - origin) * inverse)));
        };
        const int col0 = first(std::min({a.x(), b.x(), c.x()}), lattice.x0_mm);
        const int col1 = last(std::max({a.x(), b.x(), c.x()}), lattice.x0_mm, lattice.cols);
        const int row0 = first(std::min({a.y(), b.y(), c.y()}), lattice.y0_mm);
        const int row1 = last(std::max({a.y(), b.y(), c.y()}), lattice.y0_mm, lattice.rows);
        for (int row = row0; row <= row1; ++row) {
            const double y = lattice.y0_mm + row * lattice.spacing_mm;
            for (int col = col0; col <= col1; ++col) {
                const double x = lattice.x0_mm + col * lattice.spacing_mm;
                const double wb = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) * per_area;
                const double wc = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) * per_area;
                const double wa = 1.0 - wb - wc;
                // A hair of tolerance: a ray along a shared edge must not slip through.
                if (wa < -1e-9 || wb < -1e-9 || wc < -1e-9) continue;
                const double z = wa * a.z() + wb * b.z() + wc * c.z();
                auto& hit = hits[static_cast<std::size_t>(row) * static_cast<std::size_t>(lattice.cols) +
                                 static_cast<std::size_t>(col)];
                if (hit.hit() && hit.z_mm >= z) continue;
                hit = {t, {wa, wb, wc}, z, area > 0};
            }
        }
    }
    return hits;
}

}  // namespace mimik::synthesis
