#include "facs/catalogue_edit.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "base/errors.h"
#include "facs/facs_catalogue.h"

namespace mimik::facs {
namespace {

/// Bytes of a text that give way to others.
struct Replacement {
    std::size_t begin = 0, end = 0;
    std::string by;
};

/// Where a place of the parser is in the bytes of the text: it counts characters, from 1.
std::size_t byte_of(const std::string& text, const toml::source_position& place) {
    std::size_t at = 0;
    for (std::size_t line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
    for (std::size_t column = 1; column < place.column && at < text.size(); ++column) do
            ++at;
        while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U);
    return at;
}

const toml::table* point_of(const toml::table& document, const PointOffset& wanted) {
    const auto* units = document["au"].as_array();
    if (!units) return nullptr;
    for (const auto& unit : *units) {
        const auto* table = unit.as_table();
        if (!table || (*table)["number"].value_or(0) != wanted.unit) continue;
        const auto* points = (*table)["points"].as_array();
        if (!points) return nullptr;
        for (const auto& entry : *points)
            if (const auto* point = entry.as_table(); point && (*point)["name"].value_or(std::string()) == wanted.point)
                return point;
    }
    return nullptr;
}

Replacement replacement_of(const std::string& text, const toml::table& point, const PointOffset& wanted) {
    const auto list = fmt::format("[{:.3f}, {:.3f}]", wanted.lateral, wanted.up);
    if (const auto* old = point.get("offset"))
        return {byte_of(text, old->source().begin), byte_of(text, old->source().end), list};
    // What every point has: its landmarks. The offset comes after them, as it is read.
    const auto after = byte_of(text, point.get("at")->source().end);
    return {after, after, fmt::format("{}offset = {}", point.is_inline() ? ", " : "\n", list)};
}

}  // namespace

std::string with_offsets(const std::string& text, std::span<const PointOffset> offsets) {
    (void)parse_catalogue(text, "catalogue");  // says what is wrong with it
    const auto document = toml::parse(text);
    std::vector<Replacement> replacements;
    for (const auto& wanted : offsets) {
        const auto* point = point_of(document, wanted);
        if (!point) throw InputError(fmt::format("the catalogue has no point '{}' of AU{}", wanted.point, wanted.unit));
        replacements.push_back(replacement_of(text, *point, wanted));
    }
    // From the end, so that what comes before stays where it is.
    std::sort(replacements.begin(), replacements.end(),
              [](const Replacement& a, const Replacement& b) { return a.begin > b.begin; });
    for (std::size_t k = 1; k < replacements.size(); ++k)
        if (replacements[k].begin == replacements[k - 1].begin)
            throw InputError("a point of the catalogue is to be moved twice; move it once");
    std::string edited = text;
    for (const auto& [begin, end, by] : replacements) edited.replace(begin, end - begin, by);
    (void)parse_catalogue(edited, "the edited catalogue");
    return edited;
}

}  // namespace mimik::facs
