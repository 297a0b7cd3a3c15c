#include <algorithm>
#include <cmath>

#include "capture/c3d.h"
#include "capture/motion_file.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

using namespace capture;

constexpr auto format = MotionFormat::MIMIK_FUZZED;

MarkerSequence take() {
    MarkerSequence sequence({"LBRO", "Actor:lip", "chin"}, 120, 4, 7);
    for (std::size_t frame = 0; frame < 4; ++frame)
        for (std::size_t marker = 0; marker < 3; ++marker)
            if (frame + marker != 3) sequence.set(frame, marker, Point(1.5, -2.25, double(frame)));
    return sequence;
}

}  // namespace

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto file = decode_motion(format, bytes, "input");
    const auto& markers = file.markers;
    require(markers.markers() > 0 && markers.frames() > 0 && markers.rate_hz() > 0, "nothing is empty in silence");
    require(markers.markers() * markers.frames() <= std::max<std::size_t>(1'000'000, 40 * bytes.size()),
            "memory goes with the file");
    for (std::size_t frame = 0; frame < markers.frames(); ++frame)
        for (std::size_t marker = 0; marker < markers.markers(); ++marker)
            require(markers.at_mm(frame, marker).allFinite(), "positions are finite");
    MotionReadOptions options;
    options.rate_hz = markers.rate_hz();  // a table of one frame has no time that says it
    // Doubles read back from TRC; from C3D those that are floats.
    const auto text = encode_motion(MotionFormat::trc, markers, "again");
    const auto again = decode_motion(
        MotionFormat::trc, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "again", options);
    for (std::size_t frame = 0; frame < markers.frames(); ++frame)
        for (std::size_t marker = 0; marker < markers.markers(); ++marker)
            require(again.markers.valid(frame, marker) == markers.valid(frame, marker) &&
                        again.markers.at_mm(frame, marker) == markers.at_mm(frame, marker),
                    "what was written reads back");
}

std::vector<std::string> seeds() {
    if (format == MotionFormat::c3d) {
        std::vector<std::string> files;
        for (const auto processor : {C3dProcessor::intel, C3dProcessor::dec, C3dProcessor::sgi}) {
            C3dWriteOptions options;
            options.processor = processor;
            files.push_back(encode_c3d(take(), "seed", options));
            options.integer_step_mm = 0.25;
            files.push_back(encode_c3d(take(), "seed", options));
        }
        return files;
    }
    std::vector<std::string> files = {encode_motion(format, take(), "seed")};
    if (format == MotionFormat::csv) {
        files.emplace_back("frame,time,marker,x,y,z\n1,0,a,1,2,3\n2,0.1,a,,,\n2,0.1,b,4,5,nan\n");
        files.emplace_back("Time;a.X;a.Y;a.Z\n0;1,5;2;3\n0,01;;;\n");
    }
    if (format == MotionFormat::trc) {
        auto spaces = files[0];
        std::replace(spaces.begin(), spaces.end(), '\t', ' ');
        files.push_back(spaces);
    }
    return files;
}

}  // namespace mimik::fuzzing
