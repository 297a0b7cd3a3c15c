#include "facs/toml_depth.h"

#include <algorithm>

namespace mimik::facs {
namespace {

/// Takes a string off the front of `rest`, which begins with its quote: "basic", 'literal', and both over several
/// lines within three quotes. One without an end ends with its line, or with the text.
std::string_view take_string(std::string_view& rest) {
    const char quote = rest[0];
    const bool escapes = quote == '"';
    const bool several_lines = rest.size() > 2 && rest[1] == quote && rest[2] == quote;
    const std::size_t quotes = several_lines ? 3 : 1;
    std::size_t at = quotes;
    while (at < rest.size()) {
        if (escapes && rest[at] == '\\') {
            at += 2;
            continue;
        }
        if (!several_lines && rest[at] == '\n') break;
        if (rest[at] == quote && (!several_lines || rest.substr(at, 3) == rest.substr(0, 3))) {
            at += quotes;
            // Up to two quotes more belong to the text.
            for (int k = 0; several_lines && k < 2 && at < rest.size() && rest[at] == quote; ++k) ++at;
            break;
        }
        ++at;
    }
    const auto taken = rest.substr(0, std::min(at, rest.size()));
    rest.remove_prefix(taken.size());
    return taken;
}

std::size_t line_breaks(std::string_view text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

std::size_t line_too_deep(std::string_view toml, std::size_t deepest) {
    std::size_t line = 1, brackets = 0, dots = 0;
    while (!toml.empty()) {
        const char c = toml[0];
        if (c == '"' || c == '\'') {
            line += line_breaks(take_string(toml));
            continue;
        }
        if (c == '#') {
            toml.remove_prefix(std::min(toml.find('\n'), toml.size()));
            continue;
        }
        toml.remove_prefix(1);
        if (c == '.')
            ++dots;
        else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{' || c == ']' || c == '}')
            dots = 0;  // a key has ended
        if (c == '[' || c == '{') ++brackets;
        if ((c == ']' || c == '}') && brackets > 0) --brackets;
        if (dots > deepest || brackets > deepest) return line;
        if (c == '\n') ++line;
    }
    return 0;
}

}  // namespace mimik::facs
