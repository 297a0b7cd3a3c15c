#include "geometry/face_surface.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/polygon_triangles.h"

namespace mimik::geometry {

FaceSurface face_surface(const QuadGrid& grid, Landmarks landmarks) {
    FaceSurface surface{grid.vertices_mm,           triangles(grid),      VertexMask(grid.size(), 0),
                        VertexMask(grid.size(), 0), std::move(landmarks), GridShape{grid.rows, grid.cols}};
    for (std::size_t v = 0; v < grid.size(); ++v) {
        surface.present[v] = grid.inside(v) ? 1 : 0;
        surface.measured[v] = grid.measured(v) ? 1 : 0;
    }
    return surface;
}

FaceSurface face_surface(const Mesh& mesh, Landmarks landmarks) {
    if (mesh.faces.size() == 0)
        throw InputError(
            fmt::format("the mesh has {} and no face; a face is animated by its surface, so give a mesh with faces",
                        base::counted(mesh.vertices_mm.size(), "vertex", "vertices")));
    FaceSurface surface{mesh.vertices_mm,
                        triangulate(mesh.faces, mesh.vertices_mm),
                        VertexMask(mesh.vertices_mm.size(), 0),
                        {},
                        std::move(landmarks)};
    for (const auto& triangle : surface.triangles)
        for (const auto v : triangle) {
            if (!surface.vertices_mm[v].allFinite())
                throw InputError(
                    fmt::format("vertex {} of the mesh has a coordinate that is not finite; leave its "
                                "faces out",
                                v));
            surface.present[v] = 1;
        }
    surface.measured = surface.present;
    return surface;
}

DisplacementField DisplacementField::still(std::size_t vertices) {
    return {std::vector<Vector>(vertices, Vector::Zero()), VertexMask(vertices, 1)};
}

FieldExtent field_extent(const FaceSurface& surface, std::span<const Vector> field_mm,
                         const Eigen::Matrix3d& frame_from_field) {
    FieldExtent extent;
    const auto keep_largest = [&](double& largest, const Vector& difference) {
        const double length = (frame_from_field * difference).norm();
        if (!(length <= largest)) largest = std::isnan(length) ? std::numeric_limits<double>::infinity() : length;
    };
    for (std::size_t v = 0; v < surface.size(); ++v)
        if (surface.present[v]) keep_largest(extent.largest_displacement_mm, field_mm[v]);
    const auto step = [&](std::size_t a, std::size_t b) {
        if (surface.present[a] && surface.present[b])
            keep_largest(extent.largest_neighbour_step_mm, field_mm[a] - field_mm[b]);
    };
    if (surface.grid) {
        const auto rows = static_cast<std::size_t>(surface.grid->rows),
                   cols = static_cast<std::size_t>(surface.grid->cols);
        for (std::size_t v = 0; v < rows * cols; ++v) {
            if (v + cols < rows * cols) step(v, v + cols);
            if (v % cols + 1 < cols) step(v, v + 1);
        }
        return extent;
    }
    for (const auto& [a, b, c] : surface.triangles) {
        step(a, b);
        step(b, c);
        step(c, a);
    }
    return extent;
}

Mesh moved(Mesh mesh, const DisplacementField& field) {
    if (field.size() != mesh.vertices_mm.size())
        throw InputError(fmt::format("a field of {} for a mesh of {}; take the field of this mesh's own surface",
                                     base::counted(field.size(), "vertex", "vertices"), mesh.vertices_mm.size()));
    for (std::size_t v = 0; v < field.size(); ++v) mesh.vertices_mm[v] += field.mm[v];
    return mesh;
}

}  // namespace mimik::geometry
