#pragma once

#include <string>
#include <vector>

namespace mimik::capture {

/// Names as files have them, fit to be told apart and printed: one that is empty is called by its number, a name that
/// is there again gets its number, control characters become '?', bytes that are no UTF-8 are taken as Latin-1. Each of
/// these is said in `remarks`.
[[nodiscard]] std::vector<std::string> usable_names(std::vector<std::string> names, std::vector<std::string>& remarks);

}  // namespace mimik::capture
