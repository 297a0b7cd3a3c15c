#include "database/scan_id.h"

#include <algorithm>
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

std::weak_ordering compare_ignoring_case(std::string_view a, std::string_view b) {
    return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::weak_ordering(upper(x) <=> upper(y));
    });
}

std::vector<std::string_view> fields_of(std::string_view text) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0;;) {
        const auto end = text.find('_', begin);
        parts.push_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
        if (end == std::string_view::npos) return parts;
        begin = end + 1;
    }
}

/// The unit of a code that is one unit; empty for emotions, combinations and whatever else.
std::optional<facs::UnitOnSide> unit_of(const ScanId& id) {
    return facs::group_holds_units(id.group) ? facs::parse_unit_code(id.code) : std::nullopt;
}

}  // namespace

std::string ScanId::name() const { return fmt::format("{}_{}_{}_{}", subject, group, code, repetition); }
facs::Expression ScanId::expression() const {
    if (neutral()) return {};
    const auto upper_case = [](std::string text) {
        std::transform(text.begin(), text.end(), text.begin(), upper);
        return text;
    };
    auto shown_group = upper_case(group);
    const bool units = facs::group_holds_units(shown_group) || shown_group == "CAU";
    return facs::Expression::of_word(std::move(shown_group), upper_case(code),
                                     units ? facs::parse_unit_codes(code) : std::vector<facs::UnitOnSide>());
}
std::string ScanId::group_and_code() const { return fmt::format("{}_{}", group, code); }
bool ScanId::neutral() const { return base::equal_ignoring_case(group, "N"); }

std::optional<int> ScanId::action_unit() const {
    const auto unit = unit_of(*this);
    return unit ? std::optional(unit->unit) : std::nullopt;
}

facs::Side ScanId::side() const {
    const auto unit = unit_of(*this);
    return unit ? unit->side : facs::Side::both;
}

bool ScanId::low_intensity() const {
    const std::string text = base::lower_case(code);
    return text.size() > 2 && text.ends_with("lw") && digit(text[text.size() - 3]);
}

ScanId ScanId::mirrored() const {
    ScanId result = *this;
    if (side() == facs::Side::left) result.code.back() = code.back() == 'l' ? 'r' : 'R';
    if (side() == facs::Side::right) result.code.back() = code.back() == 'r' ? 'l' : 'L';
    return result;
}

std::weak_ordering ScanId::operator<=>(const ScanId& other) const {
    if (const auto order = compare_ignoring_case(subject, other.subject); std::is_neq(order)) return order;
    if (const auto order = std::weak_ordering(other.neutral() <=> neutral()); std::is_neq(order)) return order;
    if (const auto order = compare_ignoring_case(group, other.group); std::is_neq(order)) return order;
    if (const auto order = std::weak_ordering(facs::leading_number(code) <=> facs::leading_number(other.code));
        std::is_neq(order))
        return order;
    if (const auto order = compare_ignoring_case(code, other.code); std::is_neq(order)) return order;
    return repetition <=> other.repetition;
}

std::optional<ScanId> parse_scan_name(std::string_view stem) {
    const auto parts = fields_of(stem);
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

}  // namespace mimik::database
