#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::synthesis {

/// A lattice of parallel rays along -z.
struct RasterLattice {
    double x0_mm = 0, y0_mm = 0;  ///< of row 0, column 0 (row 0 lowest)
    double spacing_mm = 1;
    int rows = 0, cols = 0;
};

/// What the ray through one lattice point meets first (largest z).
struct RasterHit {
    static constexpr std::uint32_t none = 0xffffffff;
    std::uint32_t triangle = none;
    Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
    double z_mm = 0;
    bool front = false;  ///< the triangle's outside faces the rays
    [[nodiscard]] bool hit() const { return triangle != none; }
};

/// Orthographic depth raster of a triangle surface; both sides of a triangle stop a ray. Ties go to the lower index.
[[nodiscard]] std::vector<RasterHit> depth_raster(std::span<const geometry::Point> vertices_mm,
                                                  std::span<const geometry::Triangle> triangles,
                                                  const RasterLattice& lattice);

}  // namespace mimik::synthesis
