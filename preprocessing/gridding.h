#pragma once

#include <cstddef>
#include <optional>

#include "base/fields.h"
#include "geometry/quad_grid.h"
#include "geometry/range_scan.h"

namespace mimik::preprocessing {

struct GriddingOptions {
    int rows = 150;  ///< the thesis's grid (Sec. 5.4)
    int cols = 150;
    /// A triangle with an edge longer than this in x-y, mm, spans a hole or a concavity: vertices in it are `bridged`.
    /// Not for meshes: there all that no face covers is.
    /// Unset: `max_edge_spacings` times the scan's median point spacing, so that it suits every scanner.
    std::optional<double> max_edge_mm;
    /// 3 spacings bridge one lost point of a lattice (edges up to 2 spacings) and a steep or noisy stretch, but not a
    /// hole of three points across.
    double max_edge_spacings = 3.0;
    /// Organised scans: split the scanner's own cells; meshes: draw their faces; instead of triangulating every point.
    bool use_lattice = true;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("rows", self.rows);
        visit("cols", self.cols);
        visit("max_edge_mm", self.max_edge_mm);
        visit("max_edge_spacings", self.max_edge_spacings);
        visit("use_lattice", self.use_lattice);
    }
    /// @throws InputError naming the field and its value.
    void check() const;
};
static_assert(base::lists_every_field<GriddingOptions>());

enum class GriddingMethod {
    lattice,  ///< the scanner's cells, and a Delaunay triangulation of the rims alone
    mesh,     ///< the faces of a mesh, and a Delaunay triangulation of their visible rims alone
    delaunay  ///< a Delaunay triangulation of every point
};

/// How a grid came about.
struct GriddingReport {
    GriddingMethod method = GriddingMethod::delaunay;
    std::size_t points = 0;            ///< valid points of the scan
    std::size_t measured = 0;          ///< vertices between measured points that are close together
    std::size_t bridged = 0;           ///< vertices inside the hull, but across a hole or a concavity
    std::size_t outside = 0;           ///< vertices outside the hull: z is NaN
    std::size_t duplicates = 0;        ///< points that share x and y with another; z was averaged (delaunay only)
    std::size_t folded_triangles = 0;  ///< lattice triangles seen from behind; left out (lattice only)
    std::size_t rim_points = 0;        ///< points on outer borders and rims of holes (not delaunay)
    std::size_t pit_vertices = 0;      ///< vertices that show the inside of a head through an opening (mesh only)
    double seen_through = 0.0;         ///< share of the close triangles that join front and back (delaunay only)
    double spacing_mm = 0.0;           ///< median distance of neighbours in x-y
    double max_edge_mm = 0.0;          ///< the bound that was used; 0 for a mesh
};

/// The thesis's resampling (Sec. 5.4): `linspace` over the bounding box of the valid points, `meshgrid`, and z linearly
/// interpolated on a Delaunay triangulation of (x, y) as MATLAB's griddata does it. Outside the convex hull z (and the
/// texture coordinate) is NaN; a vertex on the hull is inside. Texture coordinates are interpolated with the same
/// weights. Row 0 has the lowest y, column 0 the lowest x.
///
/// `delaunay` triangulates every point; z of points with the same x and y is averaged, as griddata does.
/// `lattice` splits each scanner cell along its Delaunay diagonal (a tie: from (row, col) to (row + 1, col + 1)), and
/// fills what the cells leave open - holes, concavities, lost points - from the Delaunay triangulation of the points on
/// their rims. Cells that a tilted pose folds over (seen from behind) are left out, and where sheets still overlap the
/// one nearest to the camera (highest z) counts.
/// `mesh` draws the faces that a scan without a lattice has, whatever their winding, and the one nearest to the camera
/// counts: the back of a head, ears and inner lips stay hidden, and where the surface drops out of sight the farther
/// vertex is `bridged`. What is seen through an opening - a small patch, behind, and set apart by drops of more than 10
/// mm on all sides, as the inside of the head where there are no eyeballs - is taken for a hole. Rims are filled as
/// above, but all of it is `bridged`. A cloud has neither: where points lie behind one another, close triangles that
/// join front and back are `bridged`, and `seen_through` counts them.
/// @throws InputError for bad options or a scan with fewer than three valid points; NumericalError if all lie on a
/// line.
[[nodiscard]] geometry::QuadGrid grid_scan(const geometry::RangeScan& scan, const GriddingOptions& options = {},
                                           GriddingReport* report = nullptr);

}  // namespace mimik::preprocessing
