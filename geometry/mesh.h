#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/types.h"

namespace mimik::geometry {

/// Polygons of any size in one flat array. Face f has the corners [first[f], first[f + 1]).
struct Faces {
    std::vector<std::uint32_t> corners;          ///< vertex indices, counter-clockwise seen from outside
    std::vector<std::uint32_t> first = {0};      ///< number of faces + 1 entries
    std::vector<std::uint32_t> texture_corners;  ///< indices into Mesh::texture_coordinates, parallel to `corners`;
                                                 ///< empty: the texture index is the vertex index

    [[nodiscard]] std::size_t size() const { return first.size() - 1; }
    [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t face) const {
        return std::span(corners).subspan(first[face], first[face + 1] - first[face]);
    }
    void add(std::span<const std::uint32_t> face);
};

/// Named values per vertex, e.g. "displacement_mm" (3 components) or "distance_mm" (1).
struct VertexAttribute {
    std::string name;
    int components = 1;
    std::vector<double> values;  ///< components x vertices, vertex after vertex
};

/// A surface (or, without faces, a bare cloud) as files hold it.
struct Mesh {
    std::vector<Point> vertices_mm;
    Faces faces;
    std::vector<TextureCoordinate> texture_coordinates;  ///< empty, or one per vertex, or as `texture_corners` says
    std::vector<std::array<std::uint8_t, 3>> colours;    ///< empty, or RGB per vertex
    std::vector<VertexAttribute> attributes;             ///< each name once: readers take the first of two
};

using Triangle = std::array<std::uint32_t, 3>;

/// Every polygon as a fan of triangles from its first corner; a quad (a, b, c, d) gives abc and acd.
[[nodiscard]] std::vector<Triangle> triangulate(const Faces& faces);

/// Unit normals per vertex, area weighted; zero where no face touches the vertex.
[[nodiscard]] std::vector<Vector> vertex_normals(std::span<const Point> vertices_mm,
                                                 std::span<const Triangle> triangles);

}  // namespace mimik::geometry
