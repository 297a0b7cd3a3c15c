#include "facs/expression.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include "base/text.h"

namespace mimik::facs {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }

bool known_group(std::string_view group) {
    static constexpr std::array<std::string_view, 11> groups = {"N",  "E",  "LFAU", "UFAU", "CAU",  "YR",
                                                                "PR", "CR", "O",    "IGN",  "OTHER"};
    return std::find(groups.begin(), groups.end(), group) != groups.end();
}

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0;;) {
        const auto end = text.find(at, begin);
        parts.push_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
        if (end == std::string_view::npos) return parts;
        begin = end + 1;
    }
}

/// A code becomes part of file names and of JSON.
std::string plain_code(std::string_view code) {
    const bool utf8 = base::is_utf8(code);
    std::string plain(code);
    for (char& c : plain) {
        const bool beyond_ascii = static_cast<unsigned char>(c) >= 0x80;
        if (!(beyond_ascii ? utf8 : std::isalnum(static_cast<unsigned char>(c)) || c == '+')) c = '-';
    }
    return plain;
}

/// The units of "A22A025"; empty if a part is none.
std::vector<UnitOnSide> combined_units(std::string_view text) {
    if (!text.starts_with('A')) return {};
    std::vector<UnitOnSide> units;
    for (const auto part : split(text.substr(1), 'A')) {
        const auto unit = parse_unit_code(part);
        if (!unit) return {};
        units.push_back(*unit);
    }
    return units;
}

std::string joined_code(std::span<const UnitOnSide> units) {
    std::string code;
    for (const auto& unit : units) code += 'A' + unit.code();
    return code;
}

/// "LFAU_012": the group is kept as it was written.
Expression in_group(std::string group, std::string_view text) {
    if (const auto unit = parse_unit_code(text); unit && group_holds_units(group))
        return Expression::of_word(std::move(group), unit->code(), {*unit});
    if (group == "CAU")
        if (auto units = combined_units(text); !units.empty()) {
            auto code = joined_code(units);
            return Expression::of_word(std::move(group), std::move(code), std::move(units));
        }
    return Expression::of_word(std::move(group), plain_code(text));
}

/// "AU12_L", "AU12+AU15"; empty if the code is not that of these units.
std::string name_of_units(std::string_view code, std::span<const UnitOnSide> units) {
    if (units.empty() || (code != units.front().code() && code != joined_code(units))) return {};
    std::string name;
    for (const auto& unit : units) {
        name += fmt::format("{}AU{}", name.empty() ? "" : "+", unit.unit);
        if (unit.side != Side::both) name += unit.side == Side::left ? "_L" : "_R";
        if (unit.low_intensity) name += "_LW";
    }
    return name;
}

/// One word in upper case, its fields separated by one '_' in place of blanks and hyphens.
std::string upper_word(std::string_view text) {
    std::string word;
    for (const char c : text)
        word +=
            c == ' ' || c == '-' || c == '\t' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto first = word.find_first_not_of('_');
    return first == std::string::npos ? std::string() : word.substr(first, word.find_last_not_of('_') - first + 1);
}

std::string_view emotion_of(std::string_view word) {
    for (const std::string_view emotion : {"ANGER", "DISGUST", "FEAR", "HAPPY", "SADNESS", "SURPRISE"})
        if (word == emotion) return emotion;
    if (word == "HAPPINESS" || word == "JOY") return "HAPPY";
    return word == "SAD" ? "SADNESS" : "";
}

std::string_view without_prefix(std::string_view part) {
    if (part.starts_with("AU")) part.remove_prefix(2);
    return part;
}

}  // namespace

std::string UnitOnSide::code() const {
    return fmt::format("{}{}", unit, low_intensity ? "LW" : side == Side::left ? "L" : side == Side::right ? "R" : "");
}

Expression Expression::of_units(std::vector<UnitOnSide> units) {
    const bool one = units.size() == 1;
    auto group = one ? group_of_action_unit(units.front().unit) : std::string("CAU");
    auto code = one ? units.front().code() : joined_code(units);
    return of_word(std::move(group), std::move(code), std::move(units));
}

Expression Expression::of_word(std::string group, std::string code, std::vector<UnitOnSide> units) {
    Expression expression;
    expression.name_ = name_of_units(code, units);
    if (expression.name_.empty()) expression.name_ = code;
    expression.group_ = std::move(group);
    expression.code_ = std::move(code);
    expression.units_ = std::move(units);
    return expression;
}

std::optional<Expression> Expression::on_both_sides() const {
    if (units_.size() != 1 || units_.front().side == Side::both) return std::nullopt;
    return of_units({{units_.front().unit, Side::both, false}});
}

std::optional<Expression> parse_expression(std::string_view text) {
    const std::string word = upper_word(text);
    if (word.empty()) return std::nullopt;
    if (word == "N" || word == "NEUTRAL" || word == "N_N") return Expression();

    if (const auto cut = word.find('_');
        cut != std::string::npos && known_group(word.substr(0, cut)) && word.find('_', cut + 1) == std::string::npos)
        return in_group(word.substr(0, cut), word.substr(cut + 1));
    if (const auto emotion = emotion_of(word); !emotion.empty()) return Expression::of_word("E", std::string(emotion));

    // "AU12_L" -> "12L"; "AU22+AU25" -> "A22A25".
    std::string compact;
    std::copy_if(word.begin(), word.end(), std::back_inserter(compact), [](char c) { return c != '_'; });
    const auto parts = split(compact, '+');
    if (parts.size() == 1) {
        if (const auto unit = parse_unit_code(without_prefix(compact))) return Expression::of_units({*unit});
        // Bosphorus combinations: A22A25.
        if (compact.size() > 2 && compact[0] == 'A' && digit(compact[1]) && compact.find('A', 1) != std::string::npos)
            return in_group("CAU", compact);
    } else {
        std::string joined;
        for (const auto part : parts) joined.append("A").append(without_prefix(part));
        if (!combined_units(joined).empty()) return in_group("CAU", joined);
    }

    std::string kept = plain_code(word);
    std::replace(kept.begin(), kept.end(), '+', '-');
    return Expression::of_word("OTHER", std::move(kept));
}

std::optional<UnitOnSide> parse_unit_code(std::string_view text) {
    const std::string code = base::lower_case(text);
    const int number = leading_number(code);
    if (number <= 0) return std::nullopt;
    const std::string_view suffix = std::string_view(code).substr(
        static_cast<std::size_t>(std::find_if_not(code.begin(), code.end(), digit) - code.begin()));
    if (suffix.empty()) return UnitOnSide{number, Side::both, false};
    if (suffix == "l") return UnitOnSide{number, Side::left, false};
    if (suffix == "r") return UnitOnSide{number, Side::right, false};
    if (suffix == "lw") return UnitOnSide{number, Side::both, true};
    return std::nullopt;
}

std::vector<UnitOnSide> parse_unit_codes(std::string_view code) {
    if (const auto unit = parse_unit_code(code)) return {*unit};
    return combined_units(code);
}

bool group_holds_units(std::string_view group) {
    static constexpr std::array<std::string_view, 8> others = {"N", "E", "CAU", "YR", "PR", "CR", "O", "IGN"};
    return std::none_of(others.begin(), others.end(),
                        [&](std::string_view other) { return base::equal_ignoring_case(group, other); });
}

std::string group_of_action_unit(int action_unit) {
    static constexpr std::array upper_face = {1, 2, 4, 5, 6, 7, 41, 42, 43, 44, 45, 46};
    return std::find(upper_face.begin(), upper_face.end(), action_unit) != upper_face.end() ? "UFAU" : "LFAU";
}

int leading_number(std::string_view code) {
    const auto end = static_cast<std::size_t>(std::find_if_not(code.begin(), code.end(), digit) - code.begin());
    if (end == 0 || end > 3) return -1;
    int number = 0;
    std::from_chars(code.data(), code.data() + end, number);
    return number;
}

}  // namespace mimik::facs
