#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "io/image.h"
#include "video/face_choice.h"
#include "video/face_curves.h"

namespace mimik::video {

/// A net that says where the 68 points lie in a picture of a face, from any ONNX file that OpenCV's dnn reads.
///
/// Input: one picture, 1 x 3 x H x W (red, green, blue) or 1 x 1 x H x W (grey), values 0 to 1, rows from the top; H
/// and W are fixed in the file. Output: 136 values x0, y0, x1, y1, ... in shares of the picture: 0, 0 is its upper left
/// corner, 1, 1 the lower right.
class LandmarkNet {
public:
    /// @throws InputError if the file is missing, no ONNX file that OpenCV reads, or of other inputs and outputs
    explicit LandmarkNet(const std::filesystem::path& onnx);
    ~LandmarkNet();
    LandmarkNet(LandmarkNet&&) noexcept;

    /// @param crop  what of the frame the net is shown; beyond the frame, the frame's nearest pixel
    /// @returns pixels of the frame, the middle of its first pixel (0, 0); none if the net gives what is no number
    [[nodiscard]] std::optional<Points68> points(const io::Image& frame, const FaceBox& crop);
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    [[nodiscard]] bool grey() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace mimik::video
