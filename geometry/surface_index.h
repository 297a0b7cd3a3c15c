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
    /// Weights of the triangle's corners; exactly 0 off an edge.
    Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
};

/// What a search looked at.
struct SearchEffort {
    std::uint64_t boxes = 0;      ///< nodes of the tree
    std::uint64_t triangles = 0;  ///< triangles measured, each as often as it was
};

/// Exact closest points on a triangle surface: build once, ask often, from any thread.
///
/// A tree of boxes with eight children per node, in single precision and rounded outwards, prunes; the triangles
/// themselves are measured in double precision (error below 1e-12 mm for faces near the origin). Among triangles at
/// exactly the same computed distance the lowest index wins, so an answer depends on the query and the surface alone:
/// not on the number of threads, on neighbouring queries or on the shape of the tree.
///
/// Shapes whose boxes lie over one another - needles, fans about one vertex, pages at one edge, piles of equal
/// triangles - are known by a sample and searched by another tree (`CrowdedSurface`), so that they cost little more
/// than others. There a corner or an edge that a thousand triangles share is measured once, for the lowest of them.
class SurfaceIndex {
public:
    /// Vertices and triangles are copied. O(n log n). Triangles without area are allowed (their edges count).
    /// @throws InputError if there is no triangle, an index is out of range, or a used coordinate is not finite or is
    /// beyond 1e9 mm.
    SurfaceIndex(std::span<const Point> vertices_mm, std::span<const Triangle> triangles);
    ~SurfaceIndex();
    SurfaceIndex(SurfaceIndex&&) noexcept;
    SurfaceIndex& operator=(SurfaceIndex&&) noexcept;

    /// @throws InputError if the query is not finite (such as a grid vertex outside the hull) or is beyond 1e9 mm.
    [[nodiscard]] SurfacePoint closest(const Point& query_mm) const;
    /// The same; adds to `effort` what the search looked at.
    [[nodiscard]] SurfacePoint closest(const Point& query_mm, SearchEffort& effort) const;
    /// Many at once, parallel; neighbouring queries that lie close together are answered faster.
    [[nodiscard]] std::vector<SurfacePoint> closest(std::span<const Point> queries_mm) const;
    /// The same answers, sooner where query k lies near the triangle `near_triangles[k]`: that of its last answer, when
    /// queries move a little at a time. @throws InputError also if the spans differ in length or a triangle is unknown.
    [[nodiscard]] std::vector<SurfacePoint> closest(std::span<const Point> queries_mm,
                                                    std::span<const std::uint32_t> near_triangles) const;
    /// True where the triangle's closest point lies on an edge that only one triangle has (the scan's border). Corners
    /// at exactly the same position count as one vertex, so a texture seam is not a border. A weight below 1e-9 counts
    /// as lying on the edge.
    [[nodiscard]] bool on_border(const SurfacePoint& point) const;
    /// First hit of the ray from `origin_mm` along `direction` (need not be unit length), either side of the surface;
    /// false if none. No ray slips through the edge between two triangles (Woop, Benthin, Wald 2013, "Watertight
    /// Ray/Triangle Intersection"). @throws InputError if the direction is zero or a number is not finite.
    [[nodiscard]] bool first_hit(const Point& origin_mm, const Vector& direction, SurfacePoint& hit) const;
    [[nodiscard]] std::span<const Triangle> triangles() const;
    [[nodiscard]] std::span<const Point> vertices_mm() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mimik::geometry
