#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace pugi {
class xml_document;
}

namespace mimik::io::formats {

/// The document, parsed by pugixml: no entity but the five built-in ones is expanded and no other file is read. A text
/// with more tags than any mesh or landmark file has is refused before it is parsed, since each one costs memory.
/// @throws InputError naming file and byte.
[[nodiscard]] std::shared_ptr<const pugi::xml_document> parse_xml(std::string_view text, const std::string& name);

}  // namespace mimik::io::formats
