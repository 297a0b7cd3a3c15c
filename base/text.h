#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mimik::base {

/// A text file line by line, for readers whose errors must name the line. Line ends may be \n or \r\n, or a bare \r
/// where the first line has one; a byte order mark is skipped. The text must outlive the reader.
class LineReader {
public:
    LineReader(std::string_view text, std::string file_name);

    [[nodiscard]] bool next();  ///< moves to the next line; false at the end of the text
    [[nodiscard]] bool next_not_blank();
    [[nodiscard]] std::string_view line() const { return line_; }  ///< without its end
    [[nodiscard]] std::size_t number() const { return number_; }   ///< 1 for the first line
    [[nodiscard]] std::size_t offset() const { return offset_; }   ///< byte where the next line starts
    [[nodiscard]] std::size_t bytes_left() const { return text_.size() - offset_; }
    [[nodiscard]] const std::string& file_name() const { return file_name_; }

    /// @throws InputError "file: line 12: <what>".
    [[noreturn]] void fail(const std::string& what) const;

private:
    std::string_view text_, line_;
    std::string file_name_;
    std::size_t number_ = 0, offset_ = 0;
    bool bare_returns_ = false;
};

/// Takes the next word (separated by blanks and tabs) off the front of `rest`; empty where there is none.
[[nodiscard]] std::string_view next_word(std::string_view& rest);
[[nodiscard]] std::string_view trimmed(std::string_view text);
[[nodiscard]] std::string lower_case(std::string_view text);  ///< ASCII letters only
[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);

/// The whole of `word` as a number, independent of the locale; a leading '+' is allowed, "nan" and "inf" are numbers.
/// A value too small for a double is 0, one too large is infinite.
[[nodiscard]] std::optional<double> parse_double(std::string_view word);
/// The same, and what old C libraries print in place of "nan" and "inf": 1.#QNAN, -1.#IND, nan(ind), 1.#INF.
[[nodiscard]] std::optional<double> parse_double_or_nan(std::string_view word);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);

/// Well-formed UTF-8 (Unicode, table 3-7): no overlong form, no half of a surrogate pair, nothing beyond U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

/// The same text as UTF-8 where it is UTF-16 (a byte order mark, or a zero beside each of the first two letters), as
/// spreadsheets save it; nothing where it is not. Halves of surrogate pairs become U+FFFD.
[[nodiscard]] std::optional<std::string> from_utf16(std::string_view text);

/// A number with its noun: "1 face", "2 faces". @param many  where it is not `one` with an s: "vertices", "faces have"
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

/// The word in single quotes for an error message: at most 40 characters, control characters as '?'.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace mimik::base
