#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "video/face_curves.h"

namespace mimik::video {

/// Which vertices of the built-in face model lie on the feature curves, each row from the subject's right to the left,
/// and which one each of the 68 usual points is.
struct BuiltinFeatureLines {
    std::array<std::vector<std::uint32_t>, curve_count> curves;
    std::array<std::uint32_t, 68> points{};
};
[[nodiscard]] BuiltinFeatureLines builtin_feature_lines();

}  // namespace mimik::video
