#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::geometry {

/// One scan as measured: holes, spikes and background still in it. Scanner frame, mm.
struct RangeScan {
    int rows = 0;  ///< of the scanner's lattice; row 0 is the lowest row (chin side)
    int cols = 0;  ///< 0 x 0: not organised (a mesh or a bare cloud)
    std::vector<Point>
        points_mm;  ///< [row * cols + col], NaN where the scanner measured nothing; or any order if 0 x 0
    std::vector<TextureCoordinate> texture_coordinates;  ///< empty, or one per point
    Faces faces;                                         ///< only where a mesh file gave them
    std::string texture_file;                            ///< in the scan's folder or below it; empty: no texture
    std::string texture_error;                           ///< why the image that the file names is not used
    std::size_t texture_seam_points = 0;                 ///< of a mesh: points with more than one texture position
    std::string material_file;                           ///< of an OBJ: where the texture's name stands, likewise

    [[nodiscard]] bool organised() const { return rows > 0; }
    [[nodiscard]] bool valid(std::size_t index) const { return std::isfinite(points_mm[index].x()); }
};

}  // namespace mimik::geometry
