#pragma once

#include <memory>
#include <span>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::peers {

/// Another implementation of the closest point on a surface.
class ClosestPointPeer {
public:
    virtual ~ClosestPointPeer() = default;
    [[nodiscard]] virtual geometry::Point closest(const geometry::Point& query_mm) const = 0;
};

/// CGAL's AABB tree (double precision).
[[nodiscard]] std::unique_ptr<ClosestPointPeer> make_cgal_peer(std::span<const geometry::Point> vertices_mm,
                                                               std::span<const geometry::Triangle> triangles);
/// Embree 3: its tree in single precision prunes (rtcPointQuery), the call-back measures in double.
[[nodiscard]] std::unique_ptr<ClosestPointPeer> make_embree_peer(std::span<const geometry::Point> vertices_mm,
                                                                 std::span<const geometry::Triangle> triangles);

}  // namespace mimik::peers
