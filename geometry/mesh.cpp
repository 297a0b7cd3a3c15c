#include "geometry/mesh.h"

namespace mimik::geometry {

void Faces::add(std::span<const std::uint32_t> face) {
    corners.insert(corners.end(), face.begin(), face.end());
    first.push_back(static_cast<std::uint32_t>(corners.size()));
}

std::vector<Triangle> triangulate(const Faces& faces) {
    std::vector<Triangle> triangles;
    triangles.reserve(faces.corners.size() - std::min(faces.corners.size(), 2 * faces.size()));
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto face = faces[f];
        for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
    }
    return triangles;
}

std::vector<Vector> vertex_normals(std::span<const Point> vertices_mm, std::span<const Triangle> triangles) {
    std::vector<Vector> normals(vertices_mm.size(), Vector::Zero());
    for (const auto& t : triangles) {
        const Vector doubled_area =
            (vertices_mm[t[1]] - vertices_mm[t[0]]).cross(vertices_mm[t[2]] - vertices_mm[t[0]]);
        for (const auto v : t) normals[v] += doubled_area;
    }
    for (auto& n : normals) {
        const double length = n.norm();
        n = length > 0 ? Vector(n / length) : Vector(Vector::Zero());
    }
    return normals;
}

}  // namespace mimik::geometry
