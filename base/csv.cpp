#include "base/csv.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"

namespace mimik::base {
namespace {

constexpr std::size_t most_columns = 10000;

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string file_name) : lines_(text, std::move(file_name)) {
    while (lines_.next_not_blank()) {
        if (trimmed(lines_.line()).starts_with('#')) continue;
        split_csv_line(lines_, fields_);
        header_ = fields_;
        auto sorted = header_;
        std::transform(sorted.begin(), sorted.end(), sorted.begin(), lower_case);
        std::sort(sorted.begin(), sorted.end());
        const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
        if (twice != sorted.end() && !twice->empty())
            lines_.fail(fmt::format("column {} appears twice; rename one of the two", in_quotes(*twice)));
        return;
    }
    throw InputError(fmt::format("{}: the file is empty; its first line must name the columns", lines_.file_name()));
}

std::optional<std::size_t> CsvReader::find_column(std::string_view name) const {
    const auto it = std::find_if(header_.begin(), header_.end(),
                                 [&](const std::string& h) { return equal_ignoring_case(h, name); });
    if (it == header_.end()) return std::nullopt;
    return static_cast<std::size_t>(it - header_.begin());
}

std::size_t CsvReader::column(std::string_view name) const {
    if (const auto found = find_column(name)) return *found;
    std::vector<std::string> names;
    for (const auto& h : header_) {
        names.push_back(in_quotes(h));
        if (names.size() == 10) break;
    }
    throw InputError(
        fmt::format("{}: column '{}' is missing from the header line; it has {} (columns are separated by commas)",
                    lines_.file_name(), name, fmt::join(names, ", ")));
}

bool CsvReader::next() {
    while (lines_.next_not_blank()) {
        if (trimmed(lines_.line()).starts_with('#')) continue;
        split_csv_line(lines_, fields_);
        if (fields_.size() != header_.size())
            lines_.fail(
                fmt::format("{} fields where the header names {} columns; mend the commas (put a name that holds a "
                            "comma in double quotes)",
                            fields_.size(), header_.size()));
        return true;
    }
    return false;
}

double CsvReader::number(std::size_t column) const {
    const auto value = parse_double(fields_[column]);
    if (!value || !std::isfinite(*value))
        lines_.fail(fmt::format("{} is {}, not a finite number; correct it or delete the line", header_[column],
                                in_quotes(fields_[column])));
    return *value;
}

void split_csv_line(const LineReader& lines, std::vector<std::string>& fields) {
    fields.clear();
    std::string_view rest = lines.line();
    for (;;) {
        if (fields.size() == most_columns)
            lines.fail(fmt::format("more than {} columns; this is no table", most_columns));
        while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\t')) rest.remove_prefix(1);
        if (rest.starts_with('"')) {
            std::string field;
            std::size_t at = 1;
            for (;; ++at) {
                if (at >= rest.size()) lines.fail("a double quote is opened and not closed; close it on the same line");
                if (rest[at] != '"') {
                    field += rest[at];
                } else if (at + 1 < rest.size() && rest[at + 1] == '"') {
                    field += '"';
                    ++at;
                } else {
                    break;
                }
            }
            rest.remove_prefix(at + 1);
            const auto comma = std::min(rest.find(','), rest.size());
            if (!trimmed(rest.substr(0, comma)).empty())
                lines.fail(fmt::format("text after a closing double quote: {}", in_quotes(rest.substr(0, comma))));
            fields.push_back(std::move(field));
            if (comma == rest.size()) return;
            rest.remove_prefix(comma + 1);
        } else {
            const auto comma = std::min(rest.find(','), rest.size());
            fields.emplace_back(trimmed(rest.substr(0, comma)));
            if (comma == rest.size()) return;
            rest.remove_prefix(comma + 1);
        }
    }
}

std::string csv_field(std::string_view text) {
    std::string field(text);
    std::replace_if(
        field.begin(), field.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    const bool plain =
        field.find_first_of(",\"") == std::string::npos && trimmed(field) == field && !field.starts_with('#');
    if (plain) return field;
    std::string quoted_field = "\"";
    for (const char c : field) {
        if (c == '"') quoted_field += '"';
        quoted_field += c;
    }
    return quoted_field + '"';
}

}  // namespace mimik::base
