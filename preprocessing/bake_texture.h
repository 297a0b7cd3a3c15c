#pragma once

#include <optional>
#include <span>

#include "geometry/quad_grid.h"
#include "geometry/range_scan.h"
#include "io/image.h"

namespace mimik::preprocessing {

/// Paints one picture for a resampled face whose scan has charts (RangeScan::charts). Neighbouring vertices of the grid
/// may lie in different charts or images, between which no position of the old images can be interpolated: so each
/// pixel of the new one gets the colour of the nearest point of the scan's surface. The grid's texture positions become
/// those in the new picture, NaN outside the face.
///
/// A grid of r x c vertices gives a picture of about 1024 pixels on its longer side, a whole number of pixels (1 to 8)
/// for each vertex. Colours are interpolated between pixels that a chart covers, so what lies between charts is not
/// mixed in. Faces without a picture, and what is no face, are of plain skin colour.
/// @param images  those of `charts`; one that is missing leaves its faces without a picture.
/// @throws InputError as geometry::SurfaceIndex.
[[nodiscard]] io::Image bake_texture(const geometry::TextureCharts& charts,
                                     std::span<const std::optional<io::Image>> images, geometry::QuadGrid& grid);

}  // namespace mimik::preprocessing
