#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace mimik::base {

/// A comma-separated table with one header line: fields may stand in double quotes ("" is a quote inside), blanks
/// around a field are dropped, blank lines and lines that start with '#' are skipped. A field never spans lines.
class CsvReader {
public:
    /// Reads the header. `text` must outlive the reader. @throws InputError if there is none, or a column name appears
    /// twice.
    CsvReader(std::string_view text, std::string file_name);
    CsvReader(std::string&& text, std::string file_name) = delete;

    [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
    /// Place of a column, its name compared without regard to case.
    [[nodiscard]] std::optional<std::size_t> find_column(std::string_view name) const;
    /// @throws InputError naming the columns there are.
    [[nodiscard]] std::size_t column(std::string_view name) const;

    /// The next row; false at the end. @throws InputError if it has more or fewer fields than the header.
    [[nodiscard]] bool next();
    [[nodiscard]] const std::string& field(std::size_t column) const { return fields_[column]; }
    /// @throws InputError naming line, column and value.
    [[nodiscard]] double number(std::size_t column) const;
    [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

private:
    LineReader lines_;
    std::vector<std::string> header_, fields_;
};

/// Splits the line that `lines` stands on. @throws InputError where quotes do not close.
void split_csv_line(const LineReader& lines, std::vector<std::string>& fields);

/// The text as one CSV field: in quotes where it holds a comma, a quote or a blank at either end. Line ends become
/// blanks.
[[nodiscard]] std::string csv_field(std::string_view text);

}  // namespace mimik::base
