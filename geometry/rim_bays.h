#pragma once

#include "geometry/quad_grid.h"

namespace mimik::geometry {

/// A face as people draw it: holes stay bridged, and so does a crack at the rim, of at most 12 vertices in a row or a
/// column of the grid, such as that before an ear. What else was bridged at the rim, between jaw and neck, say, is
/// outside then: the hull of the data closed it, and it is no hole.
[[nodiscard]] QuadGrid without_rim_bays(QuadGrid grid);

}  // namespace mimik::geometry
