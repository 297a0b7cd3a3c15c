#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mimik::cli {

/// What this program was built of, as CMake found it: {"Eigen", "3.4.0"}, ...
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& libraries();

/// Of the sources, as git had them when the program was built: "0123456789ab"; "0123456789ab+89abcdef", where they were
/// changed since, by a digest of the changes; "unknown" outside git.
[[nodiscard]] const char* commit();

}  // namespace mimik::cli
