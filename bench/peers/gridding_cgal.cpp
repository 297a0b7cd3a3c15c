#include <cstdint>
#include <limits>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "bench/peers/gridding_peer.h"

namespace mimik::peers {

namespace {
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
template <class Info>
using TriangulationOf = CGAL::Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<Info, Kernel>>>;
}  // namespace

std::vector<geometry::Triangle> delaunay_cgal(std::span<const Eigen::Vector2d> points_mm) {
    std::vector<std::pair<Kernel::Point_2, std::uint32_t>> input;
    input.reserve(points_mm.size());
    for (std::uint32_t i = 0; i < points_mm.size(); ++i)
        input.emplace_back(Kernel::Point_2(points_mm[i].x(), points_mm[i].y()), i);
    const TriangulationOf<std::uint32_t> triangulation(input.begin(), input.end());
    std::vector<geometry::Triangle> triangles;
    triangles.reserve(triangulation.number_of_faces());
    for (const auto face : triangulation.finite_face_handles())
        triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    return triangles;
}

std::vector<double> griddata_cgal(std::span<const geometry::Point> points_mm,
                                  std::span<const geometry::Point> vertices_mm) {
    using Triangulation = TriangulationOf<double>;
    std::vector<std::pair<Kernel::Point_2, double>> input;
    input.reserve(points_mm.size());
    for (const auto& p : points_mm) input.emplace_back(Kernel::Point_2(p.x(), p.y()), p.z());
    Triangulation triangulation(input.begin(), input.end());

    std::vector<double> z(vertices_mm.size(), std::numeric_limits<double>::quiet_NaN());
    Triangulation::Face_handle hint;
    for (std::size_t v = 0; v < vertices_mm.size(); ++v) {
        const Kernel::Point_2 q(vertices_mm[v].x(), vertices_mm[v].y());
        hint = triangulation.locate(q, hint);
        if (triangulation.is_infinite(hint)) {
            // On the hull the walk may end just outside: the finite neighbour holds the vertex then.
            const auto inner = hint->neighbor(hint->index(triangulation.infinite_vertex()));
            if (triangulation.triangle(inner).has_on_unbounded_side(q)) continue;
            hint = inner;
        }
        const auto triangle = triangulation.triangle(hint);
        const double a = CGAL::area(q, triangle[1], triangle[2]), b = CGAL::area(triangle[0], q, triangle[2]),
                     c = CGAL::area(triangle[0], triangle[1], q);
        z[v] = (a * hint->vertex(0)->info() + b * hint->vertex(1)->info() + c * hint->vertex(2)->info()) / (a + b + c);
    }
    return z;
}

}  // namespace mimik::peers
