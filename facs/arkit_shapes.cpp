#include "facs/arkit_shapes.h"

#include <algorithm>
#include <array>

namespace mimik::facs {

bool is_arkit_shape(std::string_view name) {
    static constexpr std::array<std::string_view, 52> names = {
        "browDownLeft",      "browDownRight",      "browInnerUp",         "browOuterUpLeft",
        "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",     "cheekSquintRight",
        "eyeBlinkLeft",      "eyeBlinkRight",      "eyeLookDownLeft",     "eyeLookDownRight",
        "eyeLookInLeft",     "eyeLookInRight",     "eyeLookOutLeft",      "eyeLookOutRight",
        "eyeLookUpLeft",     "eyeLookUpRight",     "eyeSquintLeft",       "eyeSquintRight",
        "eyeWideLeft",       "eyeWideRight",       "jawForward",          "jawLeft",
        "jawOpen",           "jawRight",           "mouthClose",          "mouthDimpleLeft",
        "mouthDimpleRight",  "mouthFrownLeft",     "mouthFrownRight",     "mouthFunnel",
        "mouthLeft",         "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft",
        "mouthPressRight",   "mouthPucker",        "mouthRight",          "mouthRollLower",
        "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",     "mouthSmileLeft",
        "mouthSmileRight",   "mouthStretchLeft",   "mouthStretchRight",   "mouthUpperUpLeft",
        "mouthUpperUpRight", "noseSneerLeft",      "noseSneerRight",      "tongueOut"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace mimik::facs
