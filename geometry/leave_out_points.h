#pragma once

#include "geometry/range_scan.h"
#include "geometry/vertex_mask.h"

namespace mimik::geometry {

/// The scan without the points that `left_out` marks. A lattice keeps its places, which become NaN; a cloud or mesh
/// loses the points, those that measure nothing, and the faces that used one of them. The mesh that texture charts keep
/// for themselves stays whole.
[[nodiscard]] RangeScan leave_out_points(const RangeScan& scan, const VertexMask& left_out);

}  // namespace mimik::geometry
