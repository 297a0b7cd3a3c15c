#pragma once

#include <string>
#include <string_view>

namespace mimik::base {

/// The text as it stands in XML, SVG or HTML, between tags or in double quotes: no character of it is markup. Control
/// characters, which XML cannot hold, become blanks.
[[nodiscard]] std::string markup_text(std::string_view text);

}  // namespace mimik::base
