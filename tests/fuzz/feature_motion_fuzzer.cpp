#include <algorithm>

#include "capture/feature_motion.h"
#include "capture/landmark_tables.h"
#include "tests/capture/points68.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

using namespace capture;

constexpr auto format = MotionTableFormat::MIMIK_FUZZED;

FeatureMotion decoded(std::string_view text) {
    switch (format) {
        case MotionTableFormat::points68:
            return decode_points68_csv(text, "input").motion;
        case MotionTableFormat::openface:
            return decode_openface_csv(text, "input").motion;
        default:
            return decode_feature_motion(text, "input");
    }
}

}  // namespace

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto text = text_of(bytes);
    const auto motion = decoded(text);
    motion.check();
    // A row of 68 points that is lost may be written in few letters, but has its commas.
    require(motion.frames.size() * motion.names.size() <= bytes.size(), "memory goes with the file");
    const auto again = decode_feature_motion(encode_feature_motion(motion), "again");
    require(again.frames.size() == motion.frames.size() && again.names == motion.names, "what was written reads back");
    for (std::size_t f = 0; f < motion.frames.size(); ++f)
        for (std::size_t k = 0; k < motion.names.size(); ++k)
            require(again.frames[f].features[k].valid == motion.frames[f].features[k].valid &&
                        again.frames[f].features[k].head_mm == motion.frames[f].features[k].head_mm,
                    "every number reads back as it was");
}

std::vector<std::string> seeds() {
    const auto face = test::face68_mm();
    if (format == MotionTableFormat::points68)
        return {test::header68() + test::row68(0, test::pixels68(face, {320, 240}, 0.1, 2)) + "1,0" +
                std::string(136, ',') + "\n"};
    if (format == MotionTableFormat::openface)
        return {test::openface_header() + test::openface_row(1, 0, face, {0.1, 0.2, 0.3}, {1, 2, 600}) +
                test::openface_row(2, 0.04, face, {0, 0, 0}, {1, 2, 600})};
    FeatureMotion motion{{"chin", "mouth_corner_left"}, 30, {}};
    motion.names[0] = "nose_tip";
    motion.frames.push_back({0,
                             TrackState::tracked,
                             0.5,
                             HeadPose{{0.1, 0, 0}, {1, 2, 600}},
                             {{true, true, {3, 4}, {1, 2, 3}}, {true, false, {0, 0}, {25, -70, 0}}}});
    motion.frames.push_back({0.04, TrackState::lost, 0, {}, {{}, {}}});
    return {encode_feature_motion(motion)};
}

}  // namespace mimik::fuzzing
