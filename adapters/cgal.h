#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <CGAL/IO/Color.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/number_utils.h>

#include "adapters/remarks.h"
#include "geometry/mesh.h"

namespace mimik::adapters {

/// CGAL's half-edge mesh of Mimik's, in the same millimetres and axes. `CgalPoint` is a point of any kernel. Faces keep
/// their corners, quads too; vertices keep their order; colours become the map "v:color", attributes of one component
/// "v:NAME". Texture coordinates and other attributes are left out with a remark.
/// @throws InputError if a face names a vertex twice or one that is not there, or cannot be joined to those before it:
/// a half-edge mesh holds surfaces only whose edges have two sides at most, turned the same way.
template <class CgalPoint>
[[nodiscard]] CGAL::Surface_mesh<CgalPoint> to_cgal(const geometry::Mesh& mesh, Remarks& remarks) {
    using Surface = CGAL::Surface_mesh<CgalPoint>;
    using Vertex = typename Surface::Vertex_index;
    check_count(mesh.vertices_mm.size(), std::numeric_limits<std::uint32_t>::max() - 1, "CGAL::Surface_mesh");
    Surface surface;
    std::vector<Vertex> vertices;
    vertices.reserve(mesh.vertices_mm.size());
    for (const auto& p : mesh.vertices_mm) vertices.push_back(surface.add_vertex(CgalPoint(p.x(), p.y(), p.z())));
    std::size_t small = 0;
    std::vector<Vertex> corners;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        corners.clear();
        for (const auto v : mesh.faces[f]) {
            check_index(v, vertices.size(), f, "CGAL::Surface_mesh");
            corners.push_back(vertices[v]);
        }
        if (corners.size() < 3) {
            ++small;
            continue;
        }
        std::vector<Vertex> sorted = corners;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
            throw InputError("CGAL::Surface_mesh: face " + std::to_string(f) +
                             " names a vertex twice; leave it out of the mesh");
        if (surface.add_face(corners) == Surface::null_face())
            throw InputError(
                "CGAL::Surface_mesh: face " + std::to_string(f) +
                " cannot be joined to those before it (an edge of three faces, or faces turned against one "
                "another); mend the mesh, or hand CGAL a polygon soup");
    }
    remark_small_faces(small, remarks);
    remark_texture(mesh, "CGAL::Surface_mesh", remarks);
    if (!mesh.colours.empty()) {
        auto colours = surface.template add_property_map<Vertex, CGAL::IO::Color>("v:color").first;
        for (std::size_t v = 0; v < vertices.size(); ++v)
            colours[vertices[v]] = CGAL::IO::Color(mesh.colours[v][0], mesh.colours[v][1], mesh.colours[v][2]);
    }
    for (const auto& attribute : mesh.attributes) {
        if (attribute.components != 1) {
            remarks.push_back("attribute \"" + attribute.name + "\" is left out: it has " +
                              std::to_string(attribute.components) + " components, a map of CGAL one");
            continue;
        }
        auto values = surface.template add_property_map<Vertex, double>("v:" + attribute.name).first;
        for (std::size_t v = 0; v < vertices.size(); ++v) values[vertices[v]] = attribute.values[v];
    }
    return surface;
}

/// Mimik's mesh of CGAL's: the way back. What was removed but not collected is left out, and vertices are numbered
/// anew. The map "v:color" becomes colours, maps of doubles become attributes; other maps are not looked for.
/// @throws InputError if a coordinate is not finite.
template <class CgalPoint>
[[nodiscard]] geometry::Mesh from_cgal(const CGAL::Surface_mesh<CgalPoint>& surface, Remarks& remarks) {
    using Vertex = typename CGAL::Surface_mesh<CgalPoint>::Vertex_index;
    geometry::Mesh mesh;
    std::vector<std::uint32_t> number(surface.number_of_vertices() + surface.number_of_removed_vertices());
    for (const Vertex v : surface.vertices()) {
        const auto& p = surface.point(v);
        number[v] = static_cast<std::uint32_t>(mesh.vertices_mm.size());
        mesh.vertices_mm.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
        if (!mesh.vertices_mm.back().allFinite())
            throw InputError("CGAL::Surface_mesh: vertex " + std::to_string(number[v]) +
                             " has a coordinate that is not finite; remove it");
    }
    std::vector<std::uint32_t> corners;
    for (const auto f : surface.faces()) {
        corners.clear();
        for (const Vertex v : surface.vertices_around_face(surface.halfedge(f))) corners.push_back(number[v]);
        mesh.faces.add(corners);
    }
    const auto colours = surface.template property_map<Vertex, CGAL::IO::Color>("v:color");
    if (colours.second)
        for (const Vertex v : surface.vertices()) {
            const CGAL::IO::Color c = colours.first[v];
            mesh.colours.push_back({c.red(), c.green(), c.blue()});
        }
    for (const auto& name : surface.template properties<Vertex>()) {
        const auto values = surface.template property_map<Vertex, double>(name);
        if (!values.second) {
            if (name != "v:color" && name != "v:point" && name != "v:connectivity" && name != "v:removed")
                remarks.push_back("map \"" + name + "\" is left out: it does not hold doubles");
            continue;
        }
        geometry::VertexAttribute attribute;
        attribute.name = name.rfind("v:", 0) == 0 ? name.substr(2) : name;
        for (const Vertex v : surface.vertices()) attribute.values.push_back(values.first[v]);
        mesh.attributes.push_back(std::move(attribute));
    }
    return mesh;
}

}  // namespace mimik::adapters
