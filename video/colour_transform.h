#pragma once

#include <array>

#include "io/image.h"
#include "video/face_patch.h"

namespace mimik::video {

/// Weights of Eq. 1: I = w1 M + w2 K + w3 V + w4 G(H), all of 0..1 but V's, which is negative.
struct ColourWeights {
    double magenta = 0.9, black = 0.9, value = -0.5, hue = 0.35;
};

/// G of Eq. 1: near 1 at the hues of lips, 0 at those of skin.
/// @param hue_deg  0 to 360
[[nodiscard]] double lip_hue(double hue_deg);
/// C of Sec. 3.1: what is bright becomes brighter, what is dim dimmer; 0 and 1 stay.
[[nodiscard]] double contrast(double intensity);

/// M, K, V of 0 to 1 and H in degrees of one colour.
struct ColourChannels {
    double magenta = 0, black = 0, value = 0, hue_deg = 0, saturation = 0;
};
[[nodiscard]] ColourChannels channels_of(double red, double green, double blue);

/// The four components of Eq. 1 of every pixel of a patch, and its saturation. Light that changes slowly over the face
/// is divided out first; where there is no colour, M and G(H) are 0.
struct ColourComponents {
    FloatImage magenta, black, value, hue, saturation;
};
[[nodiscard]] ColourComponents components_of(const io::Image& patch);

/// What stands out from the skin in a patch, 0 on skin to about 1.
struct FeatureMaps {
    FloatImage feature;  ///< Eq. 1 with its contrast: brows, lashes, nostrils, lips
    FloatImage eye;      ///< lashes, iris and the white: all that lies between the lids
    FloatImage mouth;    ///< what is between the lips: darkness and teeth
};
/// The level of skin is the median over nose and cheeks.
/// @param patch  of cut_patch()
[[nodiscard]] FeatureMaps transform_colours(const io::Image& patch, const ColourWeights& weights = {});

/// Inputs of the network that estimates the weights: mean colours of sub-areas of a patch, 0 to 1. Red, green and blue
/// of the skin; grey of the brows, of the eyes, of the nostrils; red, green, blue of the lips; grey of forehead and
/// chin.
inline constexpr std::size_t colour_input_count = 11;
using ColourInputs = std::array<double, colour_input_count>;
[[nodiscard]] ColourInputs colour_inputs(const io::Image& patch, const FaceCurves& curves);

}  // namespace mimik::video
