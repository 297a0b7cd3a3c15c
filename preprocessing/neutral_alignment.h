#pragma once

#include "geometry/vertex_mask.h"
#include "preprocessing/face.h"
#include "preprocessing/rigid_alignment.h"

namespace mimik::preprocessing {

/// Fills face.neutral_from_scan by trimmed ICP of the neutral's stable vertices onto the scan. What is below the nose
/// counts less than the rest: jaw and lips rest in another place in every scan, even where the expression is elsewhere.
void align_to_neutral(Face& face, const Face& neutral, const geometry::VertexMask& stable,
                      const RigidAlignmentOptions& options = {});

}  // namespace mimik::preprocessing
