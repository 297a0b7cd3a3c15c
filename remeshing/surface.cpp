#include "remeshing/surface.h"

#include <array>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <fmt/format.h>

#include "adapters/cgal.h"
#include "base/errors.h"
#include "geometry/polygon_triangles.h"
#include "geometry/weld.h"

namespace mimik::remeshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

bool half_edges_hold(const geometry::Mesh& bare) {
    try {
        adapters::Remarks none;  // nothing but the surface is handed over
        (void)adapters::to_cgal<Kernel::Point_3>(bare, none);
    } catch (const InputError&) {
        return false;
    }
    return true;
}

/// Vertices are doubled where a surface cannot go on; the first ones keep their numbers.
void cut_to_surface(geometry::Mesh& bare, std::vector<std::string>& remarks) {
    std::vector<Kernel::Point_3> points;
    points.reserve(bare.vertices_mm.size());
    for (const auto& p : bare.vertices_mm) points.emplace_back(p.x(), p.y(), p.z());
    std::vector<std::array<std::size_t, 3>> triangles;
    triangles.reserve(bare.faces.size());
    for (std::size_t f = 0; f < bare.faces.size(); ++f)
        triangles.push_back({bare.faces[f][0], bare.faces[f][1], bare.faces[f][2]});
    (void)CGAL::Polygon_mesh_processing::orient_polygon_soup(points, triangles);
    remarks.push_back(
        fmt::format("the surface is cut where more than two faces meet in an edge, and faces are turned to "
                    "agree with their neighbours: {} vertices are doubled",
                    points.size() - bare.vertices_mm.size()));
    for (auto k = bare.vertices_mm.size(); k < points.size(); ++k)
        bare.vertices_mm.emplace_back(points[k].x(), points[k].y(), points[k].z());
    bare.faces = {};
    for (const auto& triangle : triangles)
        bare.faces.add(std::array{static_cast<std::uint32_t>(triangle[0]), static_cast<std::uint32_t>(triangle[1]),
                                  static_cast<std::uint32_t>(triangle[2])});
}

}  // namespace

BareSurface bare_surface(const geometry::Mesh& mesh, std::vector<std::string>& remarks) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (const auto v : mesh.faces[f])
            if (v >= mesh.vertices_mm.size() || !mesh.vertices_mm[v].allFinite())
                throw InputError(
                    fmt::format("face {} uses vertex {}, which is not there or not finite; leave the face out", f, v));
    const auto triangles = geometry::triangulate(mesh.faces, mesh.vertices_mm);
    const auto first_at = geometry::weld(mesh.vertices_mm, triangles);
    geometry::Mesh bare;
    BareSurface result;
    result.vertex_of.assign(mesh.vertices_mm.size(), no_vertex);
    for (std::size_t v = 0; v < first_at.size(); ++v) {
        if (first_at[v] == geometry::not_welded) continue;
        auto& number = result.vertex_of[first_at[v]];  // a first one comes before those that it stands for
        if (number == no_vertex) {
            number = static_cast<std::uint32_t>(bare.vertices_mm.size());
            bare.vertices_mm.push_back(mesh.vertices_mm[v]);
        }
        result.vertex_of[v] = number;
    }
    for (const auto& triangle : triangles) {
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) corners[k] = result.vertex_of[triangle[k]];
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) bare.faces.add(corners);
    }
    if (bare.faces.size() == 0) throw InputError("the mesh has no face of any area; give a surface, not a cloud");
    if (!half_edges_hold(bare)) cut_to_surface(bare, remarks);
    result.mesh = std::move(bare);
    return result;
}

}  // namespace mimik::remeshing
