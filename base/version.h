#pragma once

namespace mimik::base {

/// Of the program, as CMakeLists.txt has it: "0.1.0". Meshes and models say which made them.
[[nodiscard]] const char* version();

}  // namespace mimik::base
