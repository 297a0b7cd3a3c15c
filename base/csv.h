#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace mimik::base {

/// A table with one header line: fields may stand in double quotes ("" is a quote inside), blanks around a field are
/// dropped, blank lines and lines that start with '#' are skipped. A field never spans lines.
///
/// As spreadsheets save tables: columns are separated by commas, semicolons or tabs, whichever the header line has most
/// (or as a first line "sep=;" says); numbers have a decimal point or a decimal comma, all alike; UTF-8 or UTF-16; rows
/// and columns without any content are passed over.
class CsvReader {
public:
    /// Reads the header. `text` must outlive the reader. @throws InputError if there is none, if a column name appears
    /// twice, or if the first line holds numbers in place of names.
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
    /// @throws InputError naming line, column and value; also where some numbers have a decimal point and others a
    /// decimal comma.
    [[nodiscard]] double number(std::size_t column) const;
    [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

private:
    [[nodiscard]] bool next_line();

    std::shared_ptr<const std::string> converted_;  ///< of a text in UTF-16; `lines_` reads from it
    LineReader lines_;
    char separator_ = ',';
    mutable char decimal_mark_ = '\0';  ///< that the first number with one has
    std::vector<std::string> header_, fields_;
};

/// Splits the line that `lines` stands on. @throws InputError where quotes do not close.
void split_csv_line(const LineReader& lines, std::vector<std::string>& fields, char separator = ',');

/// The text as one CSV field: in quotes where it holds a comma, a quote or a blank at either end. Line ends become
/// blanks.
[[nodiscard]] std::string csv_field(std::string_view text);

}  // namespace mimik::base
