#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::geometry {

/// How the faces of a scan lie in their images, where one position per point does not tell.
struct TextureCharts {
    std::vector<Point> points_mm;              ///< of the mesh as it was read
    Faces faces;                               ///< with texture_corners
    std::vector<TextureCoordinate> positions;  ///< images repeat: whole numbers make no difference
    std::vector<std::string> images;           ///< in the scan's folder or below it
    std::vector<std::uint32_t> image_of_face;  ///< beyond `images`: none; empty: the first
};

/// One scan as measured: holes, spikes and background still in it. Scanner frame, mm.
struct RangeScan {
    int rows = 0;                  ///< of the scanner's lattice; row 0 is the lowest row (chin side)
    int cols = 0;                  ///< 0 x 0: not organised (a mesh or a bare cloud)
    std::vector<Point> points_mm;  ///< [row * cols + col], NaN where nothing was measured; in any order if 0 x 0
    std::vector<TextureCoordinate> texture_coordinates;  ///< empty, or one per point
    Faces faces;                                         ///< only where a mesh file gave them
    std::string texture_file;                            ///< in the scan's folder or below; empty: none; or the first
    std::string texture_error;                           ///< why the image that the file names is not used
    std::size_t texture_seam_points = 0;                 ///< of a mesh: points with more than one texture position
    std::vector<std::string> material_files;             ///< of an OBJ: where the textures' names stand, likewise
    std::optional<TextureCharts> charts;                 ///< of a mesh whose texture has seams or several images
    std::vector<std::string> remarks;                    ///< what its reader left out or took otherwise than written

    [[nodiscard]] bool organised() const { return rows > 0; }
    [[nodiscard]] bool valid(std::size_t index) const { return std::isfinite(points_mm[index].x()); }
};

}  // namespace mimik::geometry
