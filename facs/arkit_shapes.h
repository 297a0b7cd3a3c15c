#pragma once

#include <string_view>

namespace mimik::facs {

/// Whether ARKit has a blendshape of this name (ARFaceAnchor.BlendShapeLocation has 52).
[[nodiscard]] bool is_arkit_shape(std::string_view name);

}  // namespace mimik::facs
