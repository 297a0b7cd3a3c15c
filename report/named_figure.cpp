#include "report/named_figure.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"

// Written by report/CMakeLists.txt: a declaration for every file of report/thesis_figures/, and thesis_figures::all().
#include "report/thesis_figures.inc"

namespace mimik::report {
namespace {

/// Chapters, the appendix, tables, and what the thesis does not have; each by its numbers.
std::array<int, 3> place_of(const std::string& name) {
    const auto numbers = [](const std::string& text) {
        const auto dash = text.find('-');
        if (dash == std::string::npos) return std::array{0, 0};
        return std::array{static_cast<int>(base::parse_integer(text.substr(0, dash)).value_or(0)),
                          static_cast<int>(base::parse_integer(text.substr(dash + 1)).value_or(0))};
    };
    const auto ranked = [&](int rank, const std::string& text) {
        const auto n = numbers(text);
        return std::array{rank, n[0], n[1]};
    };
    if (std::isdigit(static_cast<unsigned char>(name.front())) != 0) return ranked(0, name);
    if (name.starts_with("A-")) return ranked(1, name);
    if (name.starts_with("table-")) return ranked(2, name.substr(6));
    return {3, 0, 0};
}

bool of_the_thesis(const std::string& name) { return place_of(name)[0] < 2; }

/// Chapter and number of "4-1".
std::optional<std::pair<std::int64_t, std::int64_t>> number_of(std::string_view name) {
    const auto sign = name.find('-');
    if (sign == std::string_view::npos) return std::nullopt;
    const auto chapter = base::parse_integer(name.substr(0, sign)), figure = base::parse_integer(name.substr(sign + 1));
    if (!chapter || !figure || *figure < 1) return std::nullopt;
    return std::pair(*chapter, *figure);
}

/// @param list  "4-1 to 4-4, 4-7, 4-8"; of what has parts left out alone ("6-6: (a)"), nothing
bool is_among(std::string_view list, std::string_view wanted) {
    const auto number = number_of(wanted);
    if (!number || list.find(':') != std::string_view::npos) return false;
    while (!list.empty()) {
        const auto end = std::min(list.find(','), list.size());
        const auto part = base::trimmed(list.substr(0, end));
        list.remove_prefix(std::min(end + 1, list.size()));
        const auto to = part.find(" to ");
        const auto first = number_of(part.substr(0, to));
        const auto last = to == std::string_view::npos ? first : number_of(part.substr(to + 4));
        if (first && last && *first <= *number && *number <= *last) return true;
    }
    return false;
}

}  // namespace

const std::vector<NamedFigure>& named_figures() {
    static const std::vector<NamedFigure> figures = [] {
        auto all = thesis_figures::all();
        std::stable_sort(all.begin(), all.end(),
                         [](const auto& a, const auto& b) { return place_of(a.name) < place_of(b.name); });
        return all;
    }();
    return figures;
}

const NamedFigure& named_figure(const std::string& name) {
    auto wanted = base::lower_case(name);
    if (wanted.starts_with("fig-")) wanted = wanted.substr(4);
    std::vector<std::string> names;
    for (const auto& figure : named_figures()) {
        if (base::lower_case(figure.name) == wanted) return figure;
        names.push_back(figure.name);
    }
    for (const auto& left_out : left_out_figures())
        if (is_among(left_out.name, wanted))
            throw InputError(fmt::format("figure {} is not made: {}", base::in_quotes(name), left_out.reason));
    throw InputError(
        fmt::format("figure {} is not known; give one of {}", base::in_quotes(name), fmt::join(names, ", ")));
}

std::string file_stem(const NamedFigure& figure) {
    return of_the_thesis(figure.name) ? "fig-" + figure.name : figure.name;
}

const std::vector<LeftOutFigure>& left_out_figures() {
    static const std::vector<LeftOutFigure> left_out = {
        {"1-1 to 3-6", "pictures of other works, and plates of anatomy: not ours to show"},
        {"4-1 to 4-4, 4-7, 4-8", "pictures of other works"},
        {"5-1", "a flow chart: it shows no data"},
        {"5-7", "plates of anatomy; its table is table-5-7"},
        {"6-1 to 6-3, 6-6, A-1 to A-9: (a) to (c)", "photographs of FACS and plates of anatomy: not ours to show"}};
    return left_out;
}

}  // namespace mimik::report
