#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/errors.h"
#include "base/text.h"

namespace mimik::capture {

/// Tables of programs whose names of columns differ in case alone (x_0 and X_0), or whose rows may end early:
/// base::CsvReader refuses both. Commas, one header line.
class PlainTable {
public:
    PlainTable(std::string_view text, const std::string& name) : lines_(text, name) {
        if (!lines_.next_not_blank())
            throw InputError(fmt::format("{}: the file is empty; its first line must name the columns", name));
        base::split_csv_line(lines_, header_);
    }
    [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
    [[nodiscard]] std::optional<std::size_t> find(std::string_view title) const {
        for (std::size_t k = 0; k < header_.size(); ++k)
            if (header_[k] == title) return k;
        return std::nullopt;
    }
    [[nodiscard]] std::size_t column(std::string_view title) const {
        if (const auto found = find(title)) return *found;
        throw InputError(fmt::format("{}: column '{}' is missing from the header line; write the table anew",
                                     lines_.file_name(), title));
    }
    [[nodiscard]] bool next() {
        if (!lines_.next_not_blank()) return false;
        base::split_csv_line(lines_, fields_);
        if (fields_.size() > header_.size())
            fail(fmt::format("{} where the header names {}; mend the commas", base::counted(fields_.size(), "field"),
                             base::counted(header_.size(), "column")));
        return true;
    }
    [[nodiscard]] std::size_t fields() const { return fields_.size(); }
    [[nodiscard]] const std::string& field(std::size_t column) const {
        if (column >= fields_.size())
            fail(fmt::format("the line ends before {}; write it whole", base::in_quotes(header_[column])));
        return fields_[column];
    }
    [[nodiscard]] double number(std::size_t column) const {
        const auto value = base::parse_double(field(column));
        if (!value || !std::isfinite(*value))
            fail(fmt::format("{} is {}, not a finite number; correct it or delete the line", header_[column],
                             base::in_quotes(fields_[column])));
        return *value;
    }
    [[nodiscard]] std::size_t line() const { return lines_.number(); }  ///< of the row, 1 for the first of the file
    [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

private:
    base::LineReader lines_;
    std::vector<std::string> header_, fields_;
};

}  // namespace mimik::capture
