#include "io/formats/xml.h"

#include <algorithm>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/errors.h"

namespace mimik::io::formats {

std::shared_ptr<const pugi::xml_document> parse_xml(std::string_view text, const std::string& name) {
    constexpr std::ptrdiff_t most_tags = 50000, most_attributes = 500000;
    if (const auto tags = std::count(text.begin(), text.end(), '<'); tags > most_tags)
        throw InputError(fmt::format("{}: has {} XML tags, more than the {} that are read", name, tags, most_tags));
    if (const auto signs = std::count(text.begin(), text.end(), '=');
        signs > most_attributes + static_cast<std::ptrdiff_t>(text.size()) / 100)
        throw InputError(
            fmt::format("{}: has {} XML attributes, more than the {} that are read", name, signs, most_attributes));
    auto document = std::make_shared<pugi::xml_document>();
    const auto result = document->load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
        throw InputError(
            fmt::format("{}: byte {}: the XML is damaged ({})", name, result.offset, result.description()));
    return document;
}

}  // namespace mimik::io::formats
