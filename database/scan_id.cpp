#include "database/scan_id.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::database {
namespace {

char upper(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }
bool digit(char c) { return c >= '0' && c <= '9'; }

std::string upper_case(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), upper);
    return result;
}

std::weak_ordering compare_ignoring_case(std::string_view a, std::string_view b) {
    return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::weak_ordering(upper(x) <=> upper(y));
    });
}

/// The number a code begins with (at most three digits, as AUs have), -1 if it begins otherwise.
int leading_number(std::string_view code) {
    const auto end = static_cast<std::size_t>(std::find_if_not(code.begin(), code.end(), digit) - code.begin());
    if (end == 0 || end > 3) return -1;
    int number = 0;
    std::from_chars(code.data(), code.data() + end, number);
    return number;
}

struct ActionUnitCode {
    int number = 0;
    Side side = Side::both;
    bool low = false;

    /// Each code in one spelling: 12 for 012.
    [[nodiscard]] std::string text() const {
        return fmt::format("{}{}", number, low ? "LW" : side == Side::left ? "L" : side == Side::right ? "R" : "");
    }
};

/// 12, 12L, 12R, 12LW.
std::optional<ActionUnitCode> parse_action_unit_code(std::string_view text) {
    const std::string code = upper_case(text);
    const int number = leading_number(code);
    if (number <= 0) return std::nullopt;
    const std::string_view suffix = std::string_view(code).substr(
        static_cast<std::size_t>(std::find_if_not(code.begin(), code.end(), digit) - code.begin()));
    if (suffix.empty()) return ActionUnitCode{number, Side::both, false};
    if (suffix == "L") return ActionUnitCode{number, Side::left, false};
    if (suffix == "R") return ActionUnitCode{number, Side::right, false};
    if (suffix == "LW") return ActionUnitCode{number, Side::both, true};
    return std::nullopt;
}

// Groups whose codes are words or head rotations: a number in them is no action unit.
bool may_hold_action_units(std::string_view group) {
    static constexpr std::array<std::string_view, 8> others = {"N", "E", "CAU", "YR", "PR", "CR", "O", "IGN"};
    return std::find(others.begin(), others.end(), upper_case(group)) == others.end();
}

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

}  // namespace

std::string to_string(Side side) { return side == Side::left ? "left" : side == Side::right ? "right" : "both"; }

Side parse_side(std::string_view text) {
    const std::string word = upper_case(text);
    if (word == "LEFT" || word == "L") return Side::left;
    if (word == "RIGHT" || word == "R") return Side::right;
    if (word == "BOTH") return Side::both;
    throw InputError(fmt::format("side '{}' is unknown; give left, right (the subject's own) or both", text));
}

Side opposite(Side side) { return side == Side::left ? Side::right : side == Side::right ? Side::left : Side::both; }

std::string ScanId::name() const { return fmt::format("{}_{}_{}_{}", subject, group, code, repetition); }
std::string ScanId::expression() const { return fmt::format("{}_{}", group, code); }
bool ScanId::neutral() const { return upper_case(group) == "N"; }

std::optional<int> ScanId::action_unit() const {
    if (!may_hold_action_units(group)) return std::nullopt;
    const auto parsed = parse_action_unit_code(code);
    return parsed ? std::optional(parsed->number) : std::nullopt;
}

Side ScanId::side() const {
    if (!may_hold_action_units(group)) return Side::both;
    const auto parsed = parse_action_unit_code(code);
    return parsed ? parsed->side : Side::both;
}

bool ScanId::low_intensity() const {
    const std::string text = upper_case(code);
    return text.size() > 2 && text.ends_with("LW") && digit(text[text.size() - 3]);
}

ScanId ScanId::mirrored() const {
    ScanId result = *this;
    if (side() == Side::left) result.code.back() = code.back() == 'l' ? 'r' : 'R';
    if (side() == Side::right) result.code.back() = code.back() == 'r' ? 'l' : 'L';
    return result;
}

std::weak_ordering ScanId::operator<=>(const ScanId& other) const {
    if (const auto order = compare_ignoring_case(subject, other.subject); std::is_neq(order)) return order;
    if (const auto order = std::weak_ordering(other.neutral() <=> neutral()); std::is_neq(order)) return order;
    if (const auto order = compare_ignoring_case(group, other.group); std::is_neq(order)) return order;
    if (const auto order = std::weak_ordering(leading_number(code) <=> leading_number(other.code)); std::is_neq(order))
        return order;
    if (const auto order = compare_ignoring_case(code, other.code); std::is_neq(order)) return order;
    return repetition <=> other.repetition;
}

std::optional<ScanId> parse_scan_name(std::string_view stem) {
    const auto parts = split(stem, '_');
    if (parts.size() != 4 || std::any_of(parts.begin(), parts.end(), [](auto part) { return part.empty(); }))
        return std::nullopt;
    if (parts[0].front() == '.' || std::any_of(stem.begin(), stem.end(), [](unsigned char c) {
            return c == '/' || c == '\\' || c < 0x20 || c == 0x7F;
        }))
        return std::nullopt;
    const auto last = parts[3];
    if (last.size() > 6 || !std::all_of(last.begin(), last.end(), digit)) return std::nullopt;
    ScanId id{std::string(parts[0]), std::string(parts[1]), std::string(parts[2]), 0};
    std::from_chars(last.data(), last.data() + last.size(), id.repetition);
    return id;
}

ScanId scan_id_from(std::string_view stem) {
    if (auto id = parse_scan_name(stem)) return *id;
    throw InputError(fmt::format("{} is no scan name such as bs000_LFAU_12_0", base::in_quotes(stem)));
}

namespace {

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

/// "A22A025" -> "A22A25"; empty if a part is no action unit.
std::optional<std::string> combination_code(std::string_view text) {
    if (!text.starts_with('A')) return std::nullopt;
    std::string code;
    for (const auto part : split(text.substr(1), 'A')) {
        const auto unit = parse_action_unit_code(part);
        if (!unit) return std::nullopt;
        code.append("A").append(unit->text());
    }
    return code;
}

/// What stands behind the group in "LFAU_012".
std::string code_in_group(std::string_view group, std::string_view text) {
    if (const auto unit = parse_action_unit_code(text); unit && may_hold_action_units(group)) return unit->text();
    if (group == "CAU")
        if (const auto combination = combination_code(text)) return *combination;
    return plain_code(text);
}

}  // namespace

std::optional<ScanId> parse_expression(std::string_view text) {
    std::string word;  // upper case; blanks and hyphens as the underscore that separates fields
    for (const char c : text) word += c == ' ' || c == '-' || c == '\t' ? '_' : upper(c);
    const auto first = word.find_first_not_of('_');
    if (first == std::string::npos) return std::nullopt;
    word = word.substr(first, word.find_last_not_of('_') - first + 1);
    if (word == "N" || word == "NEUTRAL" || word == "N_N") return ScanId{"", "N", "N", 0};

    if (const auto cut = word.find('_');
        cut != std::string::npos && known_group(word.substr(0, cut)) && word.find('_', cut + 1) == std::string::npos)
        return ScanId{"", word.substr(0, cut), code_in_group(word.substr(0, cut), word.substr(cut + 1)), 0};

    for (const std::string_view emotion : {"ANGER", "DISGUST", "FEAR", "HAPPY", "SADNESS", "SURPRISE"})
        if (word == emotion) return ScanId{"", "E", word, 0};
    if (word == "HAPPINESS" || word == "JOY") return ScanId{"", "E", "HAPPY", 0};
    if (word == "SAD") return ScanId{"", "E", "SADNESS", 0};

    // "AU12_L" -> "12L"; "AU22+AU25" -> "A22A25".
    std::string compact;
    std::copy_if(word.begin(), word.end(), std::back_inserter(compact), [](char c) { return c != '_'; });
    const auto without_prefix = [](std::string_view part) {
        if (part.starts_with("AU")) part.remove_prefix(2);
        return part;
    };
    const auto parts = split(compact, '+');
    if (parts.size() == 1) {
        if (const auto unit = parse_action_unit_code(without_prefix(compact)))
            return ScanId{"", group_of_action_unit(unit->number), unit->text(), 0};
        // Bosphorus combinations: A22A25.
        if (compact.size() > 2 && compact[0] == 'A' && digit(compact[1]) && compact.find('A', 1) != std::string::npos)
            return ScanId{"", "CAU", code_in_group("CAU", compact), 0};
    } else {
        std::string joined;
        for (const auto part : parts) joined.append("A").append(without_prefix(part));
        if (auto code = combination_code(joined)) return ScanId{"", "CAU", std::move(*code), 0};
    }

    std::string kept = plain_code(word);
    std::replace(kept.begin(), kept.end(), '+', '-');
    return ScanId{"", "OTHER", kept, 0};
}

std::string group_of_action_unit(int action_unit) {
    static constexpr std::array upper_face = {1, 2, 4, 5, 6, 7, 41, 42, 43, 44, 45, 46};
    return std::find(upper_face.begin(), upper_face.end(), action_unit) != upper_face.end() ? "UFAU" : "LFAU";
}

}  // namespace mimik::database
