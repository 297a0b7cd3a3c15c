#pragma once

#include <cstdint>
#include <vector>

#include "io/image.h"
#include "video/face_curves.h"

namespace mimik::video {

/// Grey values, row after row from the top.
struct FloatImage {
    int width = 0, height = 0;
    std::vector<float> values;

    FloatImage() = default;
    FloatImage(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    [[nodiscard]] float at(int x, int y) const {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    /// Bilinear; beyond the border the border's value.
    [[nodiscard]] double sample(const Pixel& at) const;
};

/// Where a face lies in a frame: turn, size and shift.
struct FacePlace {
    Pixel middle = Pixel::Zero();  ///< between the outer eye corners, pixels of the frame
    double outer_eyes_px = 0;      ///< their distance
    double roll_rad = 0;           ///< > 0: the subject's left eye is lower in the image

    [[nodiscard]] Pixel frame_from_patch(const Pixel& at) const;
    [[nodiscard]] Pixel patch_from_frame(const Pixel& at) const;
};

/// By the outer corners of the subject's right and left eye, pixels of the frame.
[[nodiscard]] FacePlace place_between(const Pixel& right_corner, const Pixel& left_corner);

/// A face is looked at in a patch of one size, whatever its size in the frame: all the work on a frame takes the same
/// time at any resolution. In it the outer eye corners stand level and `patch_outer_eyes_px` apart.
inline constexpr int patch_width_px = 200, patch_height_px = 248;
inline constexpr double patch_outer_eyes_px = 112;
inline constexpr double patch_middle_x = 99.5, patch_middle_y = 88;
/// From the units of mean_face_curves() to pixels of the patch.
[[nodiscard]] Pixel patch_from_mean(const Pixel& at);

/// 8-bit RGB of the patch. What lies beyond the frame is the frame's nearest pixel.
[[nodiscard]] io::Image cut_patch(const io::Image& frame, const FacePlace& place);
/// Its grey values, 0 to 255.
[[nodiscard]] std::vector<std::uint8_t> grey_of(const io::Image& image);

}  // namespace mimik::video
