#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mimik::cli {

/// What this program was built of, as CMake found it: {"Eigen", "3.4.0"}, ...
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& libraries();

}  // namespace mimik::cli
