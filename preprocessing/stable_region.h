#pragma once

#include "facs/facs_catalogue.h"
#include "geometry/vertex_mask.h"
#include "preprocessing/face.h"

namespace mimik::preprocessing {

/// Nose bridge, inner eye corners and temples, measured vertices only; upright by `neutral.average_from_scan`.
[[nodiscard]] geometry::VertexMask stable_on_every_face(const Face& neutral);

/// Vertices of a neutral face that the expression leaves alone: measured, and outside its zones by the anchor margin,
/// upright by `neutral.average_from_scan`. If fewer than a tenth are, stable_on_every_face(); of an emotion those, the
/// nose, and the cheeks before the ears.
[[nodiscard]] geometry::VertexMask stable_vertices(const facs::FacsCatalogue& catalogue,
                                                   const facs::Expression& expression, const Face& neutral);

}  // namespace mimik::preprocessing
