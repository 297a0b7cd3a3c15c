#include "geometry/topology.h"

#include <algorithm>
#include <cstddef>

#include "geometry/disjoint_sets.h"
#include "geometry/weld.h"

namespace mimik::geometry {

namespace {

void add_sides(std::span<const std::uint32_t> face, std::vector<Edge>& edges) {
    for (std::size_t k = 0; k < face.size(); ++k) {
        const auto a = face[k], b = face[(k + 1) % face.size()];
        edges.push_back({std::min(a, b), std::max(a, b)});
    }
}

std::vector<Edge> single_ones(std::vector<Edge> edges) {
    std::sort(edges.begin(), edges.end());
    std::size_t kept = 0;
    for (std::size_t k = 0, end = 0; k < edges.size(); k = end) {
        end = k;
        while (end < edges.size() && edges[end] == edges[k]) ++end;
        if (end - k == 1) edges[kept++] = edges[k];
    }
    edges.resize(kept);
    return edges;
}

}  // namespace

std::vector<Edge> border_edges(const Faces& faces) {
    std::vector<Edge> edges;
    edges.reserve(faces.corners.size());
    for (std::size_t f = 0; f < faces.size(); ++f) add_sides(faces[f], edges);
    return single_ones(std::move(edges));
}

std::vector<Edge> border_edges(std::span<const Triangle> triangles) {
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (const auto& triangle : triangles) add_sides(triangle, edges);
    return single_ones(std::move(edges));
}

std::vector<std::uint32_t> connected_parts(std::span<const Point> vertices_mm, std::span<const Triangle> triangles) {
    auto part = weld(vertices_mm, triangles);
    DisjointSets sets(vertices_mm.size());
    for (const auto& t : triangles) {
        sets.join(part[t[0]], part[t[1]]);
        sets.join(part[t[0]], part[t[2]]);
    }
    for (auto& vertex : part)
        if (vertex != not_welded) vertex = sets.root(vertex);
    return part;
}

}  // namespace mimik::geometry
