#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/mesh.h"
#include "geometry/topology.h"

// The headers are MIT; the sources are compiled with parts of CGAL that are GPL-3.0-or-later, and so is every program
// that is linked with mimik::remeshing.

namespace mimik::remeshing {

struct RemeshOptions {
    double edge_mm = 3.0;      ///< length that all edges should have; 150 x 150 grids of faces have 1 mm
    std::size_t vertices = 0;  ///< so many vertices, by the edge length that gives them; 0: as edge_mm says
    /// Borders and protected edges lose no vertex, and those longer than 4/3 of the edge length are divided. Off: they
    /// are resampled along their line, and keep their corners.
    bool keep_lines = true;
    double crease_deg = 0.0;  ///< edges whose faces differ by more are protected; 0: none
    int iterations = 8;       ///< rounds of splits, collapses, flips and smoothing; lengths settle after about 5
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("edge_mm", self.edge_mm);
        visit("vertices", self.vertices);
        visit("keep_lines", self.keep_lines);
        visit("crease_deg", self.crease_deg);
        visit("iterations", self.iterations);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<RemeshOptions>());

struct RemeshReport {
    double edge_mm = 0.0;             ///< that was aimed at
    double mean_edge_mm = 0.0;        ///< that came out
    std::size_t protected_edges = 0;  ///< in the input, those of borders and creases among them
    std::vector<std::string> remarks;
};

/// Isotropic remeshing (Botsch and Kobbelt 2004, as CGAL has it): triangles of nearly one size whose vertices lie on
/// the surface given. Polygons are cut into triangles, vertices at one place become one. Where more than two faces meet
/// in an edge, the surface is cut there, with a remark. Texture coordinates, colours and attributes are left out with a
/// remark: the vertices are new.
/// @param protected_edges  pairs of vertices of `mesh`, such as a midline: never flipped or crossed, and kept as
/// keep_lines says.
/// @throws InputError for bad options, a mesh without faces, a protected edge that is none of the mesh, or a number of
/// vertices that what is kept exceeds.
[[nodiscard]] geometry::Mesh remesh(const geometry::Mesh& mesh, const RemeshOptions& options = {},
                                    std::span<const geometry::Edge> protected_edges = {},
                                    RemeshReport* report = nullptr);

}  // namespace mimik::remeshing
