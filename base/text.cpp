#include "base/text.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::base {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
    return word;
}

}  // namespace

LineReader::LineReader(std::string_view text, std::string file_name) : text_(text), file_name_(std::move(file_name)) {
    if (text_.starts_with("\xEF\xBB\xBF")) offset_ = 3;
    const auto end = text_.find_first_of("\r\n");
    bare_returns_ =
        end != std::string_view::npos && !text_.substr(end).starts_with('\n') && !text_.substr(end).starts_with("\r\n");
}

bool LineReader::next() {
    if (offset_ >= text_.size()) return false;
    const auto end = bare_returns_ ? text_.find_first_of("\r\n", offset_) : text_.find('\n', offset_);
    const std::size_t length = std::min(end, text_.size()) - offset_;
    line_ = text_.substr(offset_, length);
    offset_ = std::min(offset_ + length + 1, text_.size());
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++number_;
    return true;
}

bool LineReader::next_not_blank() {
    while (next())
        if (!trimmed(line_).empty()) return true;
    return false;
}

void LineReader::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", file_name_, number_, what));
}

std::string_view next_word(std::string_view& rest) {
    std::size_t begin = 0;
    while (begin < rest.size() && is_blank(rest[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest.size() && !is_blank(rest[end])) ++end;
    const auto word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text) {
    std::string lowered(text);
    std::transform(lowered.begin(), lowered.end(), lowered.begin(), lower);
    return lowered;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::optional<double> parse_double(std::string_view word) {
    word = without_plus(word);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || word.empty()) return std::nullopt;
    if (error == std::errc()) return value;
    if (error != std::errc::result_out_of_range) return std::nullopt;
    // from_chars does not say which way the range was left: 1e-400 is harmless, 1e400 is not.
    const double sign = word[0] == '-' ? -1.0 : 1.0;
    const auto exponent = word.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos ? word.substr(exponent + 1).starts_with('-')
                                                         : word.find('.') <= (word[0] == '-' ? 2U : 1U);
    return sign * (tiny ? 0.0 : std::numeric_limits<double>::infinity());
}

std::optional<double> parse_double_or_nan(std::string_view word) {
    if (const auto value = parse_double(word)) return value;
    auto text = lower_case(without_plus(word));
    const bool negative = text.starts_with('-');
    if (negative) text.erase(0, 1);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto hash = text.find('#');
    const auto kind = std::string_view(text).substr(hash == std::string::npos ? 0 : hash + 1);
    if (hash != std::string::npos && kind.starts_with("inf")) return negative ? -infinity : infinity;
    const bool no_number =
        kind.starts_with("nan") || (hash != std::string::npos &&
                                    (kind.starts_with("qnan") || kind.starts_with("snan") || kind.starts_with("ind")));
    return no_number ? std::optional(std::numeric_limits<double>::quiet_NaN()) : std::nullopt;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
    word = without_plus(word);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const auto byte = [&](std::size_t k) {
            return at + k < text.size() ? static_cast<unsigned char>(text[at + k]) : 0U;
        };
        const unsigned lead = byte(0);
        const std::size_t size = lead < 0x80   ? 1
                                 : lead < 0xC2 ? 0
                                 : lead < 0xE0 ? 2
                                 : lead < 0xF0 ? 3
                                 : lead < 0xF5 ? 4
                                               : 0;
        if (size == 0) return false;
        for (std::size_t k = 1; k < size; ++k)
            if ((byte(k) & 0xC0U) != 0x80U) return false;
        if ((lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) >= 0xA0) || (lead == 0xF0 && byte(1) < 0x90) ||
            (lead == 0xF4 && byte(1) >= 0x90))
            return false;
        at += size;
    }
    return true;
}

std::optional<std::string> from_utf16(std::string_view text) {
    const auto zero_at = [&](std::size_t at) { return at < text.size() && text[at] == '\0'; };
    const bool marked_little = text.starts_with("\xFF\xFE"), marked_big = text.starts_with("\xFE\xFF");
    const bool little = marked_little || (!zero_at(0) && zero_at(1) && !zero_at(2) && zero_at(3));
    const bool big = marked_big || (zero_at(0) && !zero_at(1) && zero_at(2) && !zero_at(3) && text.size() > 3);
    if (!little && !big) return std::nullopt;
    std::size_t at = marked_little || marked_big ? 2 : 0;
    const auto next_unit = [&] {
        const auto first = static_cast<unsigned char>(text[at]), second = static_cast<unsigned char>(text[at + 1]);
        at += 2;
        return static_cast<std::uint32_t>(little ? second << 8U | first : first << 8U | second);
    };
    std::string out;
    out.reserve(text.size() / 2);
    while (at + 1 < text.size()) {
        std::uint32_t code = next_unit();
        const bool lead = code >= 0xD800 && code < 0xDC00;
        if (lead && at + 1 < text.size()) {
            const auto before = at;
            const std::uint32_t trail = next_unit();
            if (trail >= 0xDC00 && trail < 0xE000)
                code = 0x10000 + ((code - 0xD800) << 10U) + (trail - 0xDC00);
            else
                at = before;
        }
        if (code >= 0xD800 && code < 0xE000) code = 0xFFFD;
        const auto add = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
        const auto add_tail = [&](unsigned shift) { add(0x80U | (code >> shift & 0x3FU)); };
        if (code < 0x80) {
            add(code);
        } else if (code < 0x800) {
            add(0xC0U | code >> 6U);
            add_tail(0);
        } else if (code < 0x10000) {
            add(0xE0U | code >> 12U);
            add_tail(6);
            add_tail(0);
        } else {
            add(0xF0U | code >> 18U);
            add_tail(12);
            add_tail(6);
            add_tail(0);
        }
    }
    return out;
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
    if (count == 1) return fmt::format("1 {}", one);
    return many.empty() ? fmt::format("{} {}s", count, one) : fmt::format("{} {}", count, many);
}

std::string in_quotes(std::string_view word) {
    constexpr std::size_t longest = 40;
    std::string shown(word.substr(0, longest));
    for (auto& c : shown)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
    // A cut inside a UTF-8 character would make the message itself invalid text.
    if (word.size() > longest) {
        auto whole = shown;
        for (int lost = 0; lost < 3 && !is_utf8(whole); ++lost) whole.pop_back();
        if (is_utf8(whole)) shown = whole;
    }
    return fmt::format("'{}{}'", shown, word.size() > longest ? "..." : "");
}

}  // namespace mimik::base
