#include "cli/notes.h"

#include <iostream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/terminal.h"

namespace mimik::cli {
namespace {

struct Group {
    std::string thing, text;
    std::set<std::string> things;
    std::size_t lines = 0;
    bool other_numbers = false;
};

std::string without_numbers(const std::string& text) {
    std::string plain;
    for (const char c : text) {
        const bool digit = c >= '0' && c <= '9';
        if (!digit)
            plain += c;
        else if (!plain.ends_with('#'))
            plain += '#';
    }
    return plain;
}

std::string line_of(const Group& group) {
    const auto more = group.things.size() - 1;
    auto line = group.thing.empty() ? std::string() : group.thing;
    if (more > 0) line += fmt::format(" and {} more", more);
    line += (line.empty() ? "" : ": ") + group.text;
    std::vector<std::string> remarks;
    if (group.lines > group.things.size()) remarks.push_back(fmt::format("{} times", group.lines));
    if (group.other_numbers) remarks.emplace_back("the numbers are those of the first");
    return remarks.empty() ? line : fmt::format("{} ({})", line, fmt::join(remarks, "; "));
}

}  // namespace

std::vector<std::string> grouped(const std::vector<std::string>& lines) {
    std::vector<Group> groups;
    std::map<std::string, std::size_t> known;
    for (const auto& line : lines) {
        // A thing is a name: a scan, a file, an expression. Words before a colon are part of the text.
        const auto colon = line.find(": ");
        const bool named = colon != std::string::npos && line.find(' ') > colon;
        Group one{named ? line.substr(0, colon) : std::string(), named ? line.substr(colon + 2) : line, {}, 0, false};
        const auto [place, is_new] = known.try_emplace((named ? "+" : "-") + without_numbers(one.text), groups.size());
        if (is_new) groups.push_back(one);
        auto& group = groups[place->second];
        group.things.insert(one.thing);
        group.other_numbers = group.other_numbers || one.text != group.text;
        ++group.lines;
    }
    std::vector<std::string> result;
    for (const auto& group : groups) result.push_back(line_of(group));
    return result;
}

void say_notes(const std::vector<std::string>& notes) {
    for (const auto& note : grouped(notes)) say_note(note);
}

void say_failures(const std::vector<std::string>& failures) {
    std::set<std::string> said;
    for (const auto& failure : failures)
        if (said.insert(failure).second) std::cerr << one_line(failure) << '\n';
}

}  // namespace mimik::cli
