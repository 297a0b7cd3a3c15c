#include <cmath>

#include "capture/live_link.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto motion = capture::decode_live_link_csv(text_of(bytes), "input");
    const auto frames = motion.times_s.size();
    require(motion.rate_hz > 0 && motion.tracked.size() == frames, "one state a frame");
    require(motion.values.rows() == static_cast<Eigen::Index>(frames) &&
                motion.values.cols() == static_cast<Eigen::Index>(motion.shapes.size()),
            "a value for every frame and shape");
    require(motion.values.allFinite(), "values are finite");
    for (std::size_t k = 1; k < frames; ++k) require(motion.times_s[k] > motion.times_s[k - 1], "time grows");
    // What is written again reads as the same frames; a shape that is no channel is refused.
    const auto again = capture::decode_live_link_csv(capture::encode_live_link_csv(motion), "output", motion.rate_hz);
    require(again.tracked == motion.tracked, "what is written again has the same frames");
}

std::vector<std::string> seeds() {
    return {
        "Timecode,BlendShapeCount,EyeBlinkLeft,MouthSmileRight,HeadYaw\n23:59:59:58.500,3,0.25,0.5,-0.1\n"
        "23:59:59:59.500,0\n00:00:00:00.500,3,1,0,0.3\n"};
}

}  // namespace mimik::fuzzing
