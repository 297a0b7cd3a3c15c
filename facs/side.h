#pragma once

#include <string>
#include <string_view>

namespace mimik::facs {

enum class Side { both, left, right };  ///< the subject's own

[[nodiscard]] std::string to_string(Side side);        ///< "both", "left", "right"
[[nodiscard]] Side parse_side(std::string_view text);  ///< the same words, or "l", "r"; throws InputError
[[nodiscard]] Side opposite(Side side);

}  // namespace mimik::facs
