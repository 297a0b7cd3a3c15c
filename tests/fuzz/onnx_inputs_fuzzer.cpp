#include "tests/fuzz/fuzzing.h"
#include "tests/video/onnx_file.h"
#include "video/onnx_inputs.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    for (const auto& sides : video::onnx_inputs(text_of(bytes)))
        for (const int side : sides) require(side >= 0 && side < 1'000'000, "a side is a number of pixels, or open");
}

std::vector<std::string> seeds() { return {video::onnx_file({.height = 1, .width = 1, .values = 1})}; }

}  // namespace mimik::fuzzing
