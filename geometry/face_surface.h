#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/mesh.h"
#include "geometry/quad_grid.h"
#include "geometry/types.h"
#include "geometry/vertex_mask.h"

namespace mimik::geometry {

/// Rows and columns of a surface whose vertex [row * cols + col] is a regular x-y grid's.
struct GridShape {
    int rows = 0, cols = 0;
};

/// A face that a motion is put on: a gridded scan, an average face, a template or anybody's mesh. One frame, mm.
struct FaceSurface {
    std::vector<Point> vertices_mm;      ///< of vertices that are not `present`: any, also NaN
    std::vector<Triangle> triangles;     ///< counter-clockwise seen from outside; corners are present
    VertexMask present;                  ///< part of the face
    VertexMask measured;                 ///< stands on a measurement; not where a hole was bridged
    Landmarks landmarks;                 ///< same frame
    std::optional<GridShape> grid = {};  ///< of a gridded scan

    [[nodiscard]] std::size_t size() const { return vertices_mm.size(); }
};

/// A gridded face; bridged vertices are present, those outside the face are not.
[[nodiscard]] FaceSurface face_surface(const QuadGrid& grid, Landmarks landmarks);
/// Anybody's mesh with its landmarks: every vertex of a face is present and counts as measured; polygons as
/// triangulate(). @throws InputError if it has no face, or a vertex of one is not finite.
[[nodiscard]] FaceSurface face_surface(const Mesh& mesh, Landmarks landmarks);

/// A motion: where every vertex of a surface goes, in the frame of the surface.
struct DisplacementField {
    std::vector<Vector> mm;  ///< one per vertex; zero where nothing was answered
    VertexMask answered;     ///< 0: whoever made the field has no answer there

    [[nodiscard]] std::size_t size() const { return mm.size(); }
    /// No motion anywhere, answered everywhere.
    [[nodiscard]] static DisplacementField still(std::size_t vertices);
};

/// How far a field moves the present vertices of a surface; infinite where a number is not finite.
struct FieldExtent {
    double largest_displacement_mm = 0.0;
    double largest_neighbour_step_mm = 0.0;  ///< largest change of displacement between neighbouring vertices
};
/// Neighbours are those of the grid (its rows and columns), or else the ends of the triangles' edges.
/// @param frame_from_field  linear part of the way to the frame in which lengths are wanted
[[nodiscard]] FieldExtent field_extent(const FaceSurface& surface, std::span<const Vector> field_mm,
                                       const Eigen::Matrix3d& frame_from_field = Eigen::Matrix3d::Identity());

/// The mesh with its vertices moved; everything else as it was. @throws InputError if the sizes differ.
[[nodiscard]] Mesh moved(Mesh mesh, const DisplacementField& field);

}  // namespace mimik::geometry
