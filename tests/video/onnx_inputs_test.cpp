#include "video/onnx_inputs.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/video/onnx_file.h"

using testing::ElementsAre;
using testing::IsEmpty;

namespace mimik::video {
namespace {

TEST(OnnxInputs, are_the_inputs_without_the_tensors_that_the_file_holds) {
    EXPECT_THAT(onnx_inputs(onnx_file({.depth = 3, .height = 300, .width = 4})),
                ElementsAre(ElementsAre(1, 3, 300, 4)));
    // Older files list their weights among the inputs, too.
    const auto named = [](const std::string& name) { return ProtobufText().text(1, name); };
    const auto graph = ProtobufText().part(5, ProtobufText().text(8, "weights")).part(11, named("weights"));
    EXPECT_THAT(onnx_inputs(ProtobufText().part(7, graph).bytes()), IsEmpty());
}

TEST(OnnxInputs, sides_that_the_file_leaves_open_and_absurd_ones_are_0) {
    EXPECT_THAT(onnx_inputs(onnx_file({.fixed_count = false, .fixed_size = false})),
                ElementsAre(ElementsAre(0, 3, 0, 0)));
    EXPECT_THAT(onnx_inputs(onnx_file({.depth = 1, .height = 1'000'000, .width = 1, .values = 1})),
                ElementsAre(ElementsAre(1, 1, 0, 1)));
}

TEST(OnnxInputs, a_file_cut_anywhere_gives_its_one_input_or_none) {
    const auto file = onnx_file({.height = 1, .width = 1, .values = 1});
    for (std::size_t length = 0; length < file.size(); ++length)
        EXPECT_LE(onnx_inputs(file.substr(0, length)).size(), 1U) << length << " bytes";
    EXPECT_THAT(onnx_inputs("no such file"), IsEmpty());
}

}  // namespace
}  // namespace mimik::video
