#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "bench/peers/closest_point_peer.h"

namespace mimik::peers {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>>;

class CgalPeer : public ClosestPointPeer {
public:
    CgalPeer(std::span<const geometry::Point> vertices_mm, std::span<const geometry::Triangle> triangles) {
        const auto point = [&](std::uint32_t v) {
            return Kernel::Point_3(vertices_mm[v].x(), vertices_mm[v].y(), vertices_mm[v].z());
        };
        triangles_.reserve(triangles.size());
        for (const auto& t : triangles) triangles_.emplace_back(point(t[0]), point(t[1]), point(t[2]));
        tree_.insert(triangles_.begin(), triangles_.end());
        tree_.build();
        tree_.accelerate_distance_queries();
    }
    [[nodiscard]] geometry::Point closest(const geometry::Point& q) const override {
        const auto p = tree_.closest_point({q.x(), q.y(), q.z()});
        return {p.x(), p.y(), p.z()};
    }

private:
    std::vector<Kernel::Triangle_3> triangles_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<ClosestPointPeer> make_cgal_peer(std::span<const geometry::Point> vertices_mm,
                                                 std::span<const geometry::Triangle> triangles) {
    return std::make_unique<CgalPeer>(vertices_mm, triangles);
}

}  // namespace mimik::peers
