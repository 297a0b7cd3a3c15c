#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::geometry {

struct SurfacePoint {
    Point position_mm = Point::Zero();
    double distance_mm = 0.0;
    std::uint32_t triangle = 0;
    Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< weights of the triangle's corners
};

/// Exact closest points on a triangle surface: build once, ask often, from any thread.
class SurfaceIndex {
public:
    /// Triangles are copied. @throws InputError if there is none, or an index or coordinate is bad.
    SurfaceIndex(std::span<const Point> vertices_mm, std::span<const Triangle> triangles);
    ~SurfaceIndex();
    SurfaceIndex(SurfaceIndex&&) noexcept;
    SurfaceIndex& operator=(SurfaceIndex&&) noexcept;

    [[nodiscard]] SurfacePoint closest(const Point& query_mm) const;
    /// Many at once, parallel; neighbouring queries that lie close together are answered faster.
    [[nodiscard]] std::vector<SurfacePoint> closest(std::span<const Point> queries_mm) const;
    /// True where the triangle's closest point lies on an edge that only one triangle has (the scan's border).
    [[nodiscard]] bool on_border(const SurfacePoint& point) const;
    /// First hit of the ray from `origin_mm` along `direction` (need not be unit length); false if none.
    [[nodiscard]] bool first_hit(const Point& origin_mm, const Vector& direction, SurfacePoint& hit) const;
    [[nodiscard]] std::span<const Triangle> triangles() const;
    [[nodiscard]] std::span<const Point> vertices_mm() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mimik::geometry
