#include "capture/marker_names.h"

#include <set>
#include <string_view>

#include <fmt/format.h>

#include "base/text.h"

namespace mimik::capture {
namespace {

std::string from_latin_1(std::string_view text) {
    std::string utf8;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80U) {
            utf8 += c;
        } else {
            utf8 += static_cast<char>(0xC0U | (byte >> 6U));
            utf8 += static_cast<char>(0x80U | (byte & 0x3FU));
        }
    }
    return utf8;
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

}  // namespace

std::vector<std::string> usable_names(std::vector<std::string> names, std::vector<std::string>& remarks) {
    std::size_t unnamed = 0, repeated = 0, foreign = 0, controls = 0;
    std::string first_repeated;
    std::set<std::string> seen;
    for (std::size_t k = 0; k < names.size(); ++k) {
        auto& name = names[k];
        if (!base::is_utf8(name)) {
            name = from_latin_1(name);
            ++foreign;
        }
        bool mended = false;
        for (auto& c : name)
            if (is_control(c)) {
                c = '?';
                mended = true;
            }
        controls += mended ? 1 : 0;
        name = std::string(base::trimmed(name));
        if (name.empty()) {
            name = fmt::format("unnamed {}", k + 1);
            ++unnamed;
        }
        if (seen.count(name) != 0) {
            if (repeated++ == 0) first_repeated = name;
            const auto stem = name;
            for (std::size_t number = k + 1; seen.count(name) != 0; ++number)
                name = fmt::format("{} ({})", stem, number);
        }
        seen.insert(name);
    }
    if (unnamed > 0)
        remarks.push_back(fmt::format("{} no name; called 'unnamed' with its number",
                                      base::counted(unnamed, "marker has", "markers have")));
    if (repeated > 0)
        remarks.push_back(fmt::format("{} a name that is there before ({}); its number was put behind it",
                                      base::counted(repeated, "marker has", "markers have"),
                                      base::in_quotes(first_repeated)));
    if (foreign > 0)
        remarks.push_back(fmt::format("{} no UTF-8; read as Latin-1", base::counted(foreign, "name is", "names are")));
    if (controls > 0)
        remarks.push_back(
            fmt::format("{} control characters; each became '?'", base::counted(controls, "name has", "names have")));
    return names;
}

}  // namespace mimik::capture
