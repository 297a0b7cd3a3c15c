#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/surface_index.h"
#include "geometry/triangle_foot.h"

namespace mimik::geometry {

inline constexpr std::uint32_t no_triangle = 0xFFFFFFFF;

/// The best answer of a search so far.
struct Nearest {
    Foot foot;
    std::uint32_t triangle = no_triangle;
    /// Among equal distances the lowest triangle wins.
    void consider(const Foot& other, std::uint32_t other_triangle) {
        if (other.squared_mm2 < foot.squared_mm2 ||
            (other.squared_mm2 == foot.squared_mm2 && other_triangle < triangle)) {
            foot = other;
            triangle = other_triangle;
        }
    }
};

/// Whether the boxes of so many triangles lie over one another that a tree of boxes leaves out too little: needles,
/// fans, books of pages, piles. By a sample, the same on every run; never true for the triangles of a scan, whose boxes
/// overlap their neighbours alone.
[[nodiscard]] bool is_crowded(std::span<const Point> vertices_mm, std::span<const Triangle> triangles);

/// A search for the closest point of a surface whose triangles' boxes say little. Long triangles are cut into pieces,
/// boxes are turned to fit what they hold (Gottschalk, Lin and Manocha 1996, "OBBTree"), equal triangles count once.
/// Around a hub - a corner of a thousand triangles or an edge of as many - all of them are equally near to whatever
/// lies behind it: there the hub itself is measured, once, for the lowest of its triangles, and cones of directions
/// prune the others.
class CrowdedSurface {
public:
    CrowdedSurface(std::span<const Point> vertices_mm, std::span<const Triangle> triangles);

    /// `start` is a triangle that may lie near, or `no_triangle`. The spans are those of the constructor, or copies.
    void search(std::span<const Point> vertices_mm, std::span<const Triangle> triangles, const Point& query_mm,
                std::uint32_t start, Nearest& best, SearchEffort& effort) const;

private:
    friend class CrowdedSurfaceBuilder;

    struct Node {
        Point centre;
        Eigen::Matrix3d axes;      // columns
        Vector half;               // extent along each, widened by what rounding may take
        std::uint32_t next = 0;    // a leaf's first item; else the second child, the first one follows at once
        std::uint32_t count = 0;   // a leaf's items
        std::uint32_t sector = 0;  // about a hub: a number in sectors_
    };
    /// Directions within an angle below 90 degrees of an axis; without one (cosine below 0) they may go anywhere.
    struct Cone {
        Vector axis = Vector::UnitX();
        double cosine = -1, sine = 0;
    };
    /// What triangles about a hub fill. About a corner: directions from it. About an edge: directions away from its
    /// line, and within their planes the angles at the edge's ends and the reach from the line.
    struct Sector {
        Cone cone;
        std::array<double, 2> cosine = {1, 1}, sine = {0, 0};
        double reach_mm = 0;
    };
    /// A corner (first == second) or an edge of a thousand triangles. Of its lowest triangle: which corner or edge.
    struct Hub {
        std::uint32_t first = 0, second = 0;
        std::uint32_t triangle = 0;
        int feature = 0;
    };
    struct Group {
        std::uint32_t root = 0;
        std::uint32_t hub = 0;  // a number in hubs_, or no_hub
    };
    static constexpr std::uint32_t no_hub = 0xFFFFFFFF;
    struct Standpoint;  // where a query stands to a hub

    [[nodiscard]] static double squared_distance_to(const Node& node, const Point& query_from_origin);
    [[nodiscard]] static double bound_about_corner(const Sector& sector, const Standpoint& at);
    [[nodiscard]] static double bound_about_edge(const Sector& sector, const Standpoint& at);
    void measure_hub(const Hub& hub, std::span<const Point> vertices_mm, std::span<const Triangle> triangles,
                     const Point& query_mm, Nearest& best) const;

    Point origin_ = Point::Zero();  // of the nodes' centres
    std::vector<Node> nodes_;
    std::vector<Sector> sectors_;
    std::vector<Hub> hubs_;
    std::vector<Group> groups_;
    std::vector<std::uint32_t> items_;        // triangles, in the order of the leaves
    std::vector<std::uint8_t> hub_features_;  // per triangle: bits 0-2 corners, 3-5 edges (Foot::edge) that are hubs
};

}  // namespace mimik::geometry
