#include "base/csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::base {
namespace {

constexpr std::size_t most_columns = 10000;

/// The commas, semicolons and tabs of a line that stand in no quotes: the most frequent of them; a comma if there is
/// none.
char separator_of(std::string_view line) {
    std::array<std::pair<char, std::size_t>, 3> counts = {{{'\t', 0}, {';', 0}, {',', 0}}};
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') quoted = !quoted;
        for (auto& [separator, count] : counts)
            if (c == separator && !quoted) ++count;
    }
    // As many commas as semicolons are those of numbers, in a table without a header line.
    const auto most =
        std::max_element(counts.begin(), counts.end(), [](auto& a, auto& b) { return a.second < b.second; });
    return most->second > 0 ? most->first : ',';
}

/// Of a first line "sep=;", as some spreadsheets write it before the header (perhaps in quotes, or filled up with empty
/// columns).
std::optional<char> stated_separator(std::string_view line) {
    line = trimmed(line);
    if (line.starts_with('"')) line.remove_prefix(1);
    if (!equal_ignoring_case(line.substr(0, 4), "sep=")) return std::nullopt;
    line.remove_prefix(4);
    const char separator = line.empty() ? '\t' : line.front();  // blanks at the end of a line are cut off
    const bool nothing_else = line.find_first_not_of(std::string{separator, '"', ' '}) == std::string_view::npos;
    return nothing_else && (separator == ',' || separator == ';' || separator == '\t') ? std::optional(separator)
                                                                                       : std::nullopt;
}

/// A number with a decimal point or comma, whatever it is.
bool is_number(std::string text) {
    if (std::count(text.begin(), text.end(), ',') == 1) std::replace(text.begin(), text.end(), ',', '.');
    return parse_double(text).has_value();
}

bool is_empty(const std::string& field) { return field.empty(); }

const char* name_of(char separator) { return separator == ',' ? "commas" : separator == ';' ? "semicolons" : "tabs"; }

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string file_name) : lines_(text, file_name) {
    if (auto utf8 = from_utf16(text)) {
        converted_ = std::make_shared<const std::string>(std::move(*utf8));
        lines_ = LineReader(*converted_, std::move(file_name));
    }
    if (!next_line())
        throw InputError(
            fmt::format("{}: the file is empty; its first line must name the columns", lines_.file_name()));
    const auto stated = stated_separator(lines_.line());
    if (stated && !next_line())
        throw InputError(
            fmt::format("{}: only a line 'sep=' is in it; the next must name the columns", lines_.file_name()));
    separator_ = stated ? *stated : separator_of(lines_.line());
    split_csv_line(lines_, fields_, separator_);
    header_ = fields_;
    if (std::count_if(header_.begin(), header_.end(), is_number) >= 2)
        lines_.fail(
            fmt::format("the header line is missing: {} holds numbers; put a line that names the columns before "
                        "it, such as name,x,y,z",
                        in_quotes(lines_.line())));
    auto sorted = header_;
    std::transform(sorted.begin(), sorted.end(), sorted.begin(), lower_case);
    std::sort(sorted.begin(), sorted.end());
    const auto twice =
        std::adjacent_find(sorted.begin(), sorted.end(), [](auto& a, auto& b) { return a == b && !a.empty(); });
    if (twice != sorted.end())
        lines_.fail(fmt::format("column {} appears twice; rename one of the two", in_quotes(*twice)));
}

bool CsvReader::next_line() {
    while (lines_.next_not_blank())
        if (!trimmed(lines_.line()).starts_with('#')) return true;
    return false;
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
        fmt::format("{}: column '{}' is missing from the header line; it has {} (separated by {}); name the column, or "
                    "put the header line first",
                    lines_.file_name(), name, fmt::join(names, ", "), name_of(separator_)));
}

bool CsvReader::next() {
    while (next_line()) {
        split_csv_line(lines_, fields_, separator_);
        if (std::all_of(fields_.begin(), fields_.end(), is_empty)) continue;
        while (fields_.size() > header_.size() && fields_.back().empty()) fields_.pop_back();
        const auto given = static_cast<std::ptrdiff_t>(std::min(fields_.size(), header_.size()));
        if (std::all_of(header_.begin() + given, header_.end(), is_empty))
            fields_.resize(std::max(fields_.size(), header_.size()));
        if (fields_.size() != header_.size())
            lines_.fail(fmt::format(
                "{} where the header names {}; mend the {} (put a name that holds one in double quotes{})",
                base::counted(fields_.size(), "field"), base::counted(header_.size(), "column"), name_of(separator_),
                separator_ == ',' ? "; a number has a decimal point, or stands in quotes" : ""));
        return true;
    }
    return false;
}

double CsvReader::number(std::size_t column) const {
    std::string text = fields_[column];
    const auto commas = std::count(text.begin(), text.end(), ',');
    const bool point = text.find('.') != std::string::npos;
    if (commas == 1 && !point) std::replace(text.begin(), text.end(), ',', '.');
    const auto value = parse_double(text);
    if (!value || !std::isfinite(*value))
        lines_.fail(fmt::format("{} is {}, not a finite number{}; correct it or delete the line", header_[column],
                                in_quotes(fields_[column]),
                                commas > 0 && (point || commas > 1) ? " (no mark between thousands is read)" : ""));
    if (const char mark = commas == 1 ? ',' : point ? '.' : '\0'; mark != '\0') {
        if (decimal_mark_ == '\0') decimal_mark_ = mark;
        if (decimal_mark_ != mark)
            lines_.fail(fmt::format("{} is {}, but numbers before it have a decimal {}; write all of them alike",
                                    header_[column], in_quotes(fields_[column]),
                                    decimal_mark_ == ',' ? "comma" : "point"));
    }
    return *value;
}

void split_csv_line(const LineReader& lines, std::vector<std::string>& fields, char separator) {
    fields.clear();
    std::string_view rest = lines.line();
    for (;;) {
        if (fields.size() == most_columns)
            lines.fail(fmt::format("more than {} columns; this is no table", most_columns));
        while (!rest.empty() && rest.front() != separator && (rest.front() == ' ' || rest.front() == '\t'))
            rest.remove_prefix(1);
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
            const auto end = std::min(rest.find(separator), rest.size());
            if (!trimmed(rest.substr(0, end)).empty())
                lines.fail(fmt::format("text after a closing double quote: {}", in_quotes(rest.substr(0, end))));
            fields.push_back(std::move(field));
            if (end == rest.size()) return;
            rest.remove_prefix(end + 1);
        } else {
            const auto end = std::min(rest.find(separator), rest.size());
            fields.emplace_back(trimmed(rest.substr(0, end)));
            if (end == rest.size()) return;
            rest.remove_prefix(end + 1);
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
