#pragma once

#include <cstddef>
#include <string_view>

namespace mimik::facs {

/// The first line on which brackets nest, or a key has parts ("a.b.c"), beyond `deepest`; 0: none. The parser would
/// nest its calls as deep, and a file of some kilobytes overflow the stack. Strings and comments do not count.
[[nodiscard]] std::size_t line_too_deep(std::string_view toml, std::size_t deepest);

}  // namespace mimik::facs
