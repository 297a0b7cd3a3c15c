#pragma once

#include <string_view>
#include <vector>

namespace mimik::video {

/// Sides of each input of an ONNX model, in the order of the file: 1 x 3 x H x W, say; 0 stands for a side that the
/// file leaves open, or one of a million and more. Tensors that the file itself holds are no inputs. OpenCV 4.6 does
/// not say them. Source: onnx.proto (ModelProto.graph = 7; GraphProto.input = 11, initializer = 5).
/// @param model  the bytes of the file. Damaged ones are read up to the damage; nothing is thrown.
[[nodiscard]] std::vector<std::vector<int>> onnx_inputs(std::string_view model);

}  // namespace mimik::video
