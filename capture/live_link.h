#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace mimik::capture {

/// Weights of shapes over time, as face trackers of telephones record them.
struct ShapeMotion {
    std::vector<std::string> shapes;  ///< ARKit's names, "mouthSmileLeft", and others as the file has them
    double rate_hz = 60.0;
    std::vector<double> times_s;        ///< from the first frame on
    std::vector<std::uint8_t> tracked;  ///< per frame; values of a frame that is lost are 0
    Eigen::MatrixXd values;             ///< a row per frame, a column per shape
    std::vector<std::string> remarks;

    [[nodiscard]] std::optional<std::size_t> find(std::string_view shape) const;
};

/// What Live Link Face (Unreal's program for telephones) writes: header Timecode,BlendShapeCount,EyeBlinkLeft,..., 61
/// channels: the 52 of ARKit, and the rotations of head and eyes. Timecodes are HH:MM:SS:FF or HH:MM:SS:FF.part, over
/// midnight, too. A row of 0 shapes is a frame in which the face was lost.
/// @param rate_hz  frames a second; none: the usual rate next above the largest number of a frame
/// @param name  stands for the file in errors. @throws InputError naming file, line, column, value and mend.
[[nodiscard]] ShapeMotion decode_live_link_csv(std::string_view text, const std::string& name,
                                               std::optional<double> rate_hz = {});

/// The 61 channels of Live Link Face in its order and spelling, "EyeBlinkLeft" to "RightEyeRoll".
[[nodiscard]] std::span<const std::string_view> live_link_channels();

/// What decode_live_link_csv() reads: all 61 channels, those that the motion lacks as 0; a lost frame as a row of 0
/// shapes. Timecodes count frames to their thousandth part.
/// @param start_s  of the first frame, seconds since midnight
/// @throws InputError if a shape is none of the channels, or sizes, times or the rate are not what they must be.
[[nodiscard]] std::string encode_live_link_csv(const ShapeMotion& motion, double start_s = 0);

}  // namespace mimik::capture
