#pragma once

#include <memory>

#include "evaluation/estimator.h"
#include "geometry/quad_grid.h"
#include "geometry/vertex_mask.h"

namespace mimik::evaluation {

/// Which vertices of a scan's grid stand at the border of a hole: of a part without measured quads that the measured
/// ones surround. The border of the outline is none, nor is that of a hole so small (below 7 mm^2) that nothing in it
/// is 1.5 mm from its border.
[[nodiscard]] geometry::VertexMask hole_rim(const geometry::QuadGrid& grid);

/// "over_hole": region "face", metric "vertices": measured vertices of the moved face whose nearest point of the real
/// expressive scan lies on the border of a hole (ScoredTarget::hole_rim), farther than 1.5 mm away: a web over an open
/// mouth has many. Region "mouth": those of the red of the lips alone, if the landmarks of the mouth say where that is;
/// eyes, brows and nostrils have holes, too, which differ from scan to scan.
[[nodiscard]] std::unique_ptr<const Estimator> over_hole_estimator();

}  // namespace mimik::evaluation
