#include "geometry/delaunay.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace mimik::geometry {
namespace {
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

std::pair<double, double> position(const Triangulation::Point& p) { return {p.x(), p.y()}; }
}  // namespace

std::vector<Triangle> delaunay(std::span<const Eigen::Vector2d> points_mm) {
    std::vector<std::pair<Triangulation::Point, std::uint32_t>> input;
    input.reserve(points_mm.size());
    for (std::uint32_t i = 0; i < points_mm.size(); ++i) {
        if (!points_mm[i].allFinite())
            throw InputError(
                fmt::format("point {} of the triangulation is ({}, {}); leave out points that are not finite", i,
                            points_mm[i].x(), points_mm[i].y()));
        input.emplace_back(Triangulation::Point(points_mm[i].x(), points_mm[i].y()), i);
    }
    Triangulation triangulation;
    triangulation.insert(input.begin(), input.end());
    if (triangulation.dimension() < 2)
        throw NumericalError(fmt::format(
            "{} points lie on one line or in one place; a triangulation needs three that do not", input.size()));
    if (triangulation.number_of_vertices() != points_mm.size()) {
        // CGAL keeps the index that came last in its own order of insertion; ours is the lowest.
        std::sort(input.begin(), input.end(), [](const auto& p, const auto& q) {
            return std::pair(position(p.first), p.second) < std::pair(position(q.first), q.second);
        });
        for (const auto vertex : triangulation.finite_vertex_handles())
            vertex->info() =
                std::lower_bound(input.begin(), input.end(), position(vertex->point()),
                                 [](const auto& p, const auto& where) { return position(p.first) < where; })
                    ->second;
    }
    std::vector<Triangle> triangles;
    triangles.reserve(triangulation.number_of_faces());
    for (const auto face : triangulation.finite_face_handles())
        triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    return triangles;
}

}  // namespace mimik::geometry
