#pragma once

#include <memory>

#include "synthesis/face_model.h"

namespace mimik::synthesis {

/// A dome of face size whose shapes are bumps of known displacement: enough of a face for everything but its looks.
/// z = 100 - (x^2 + y^2) / 100 on |x| <= 90, |y| <= 120; a mode makes it wider; shapes lift a Gaussian patch.
[[nodiscard]] std::unique_ptr<FaceModel> make_dome_model();

}  // namespace mimik::synthesis
