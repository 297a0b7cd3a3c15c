#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "facs/side.h"

namespace mimik::facs {

/// One Action Unit on one side or both.
struct UnitOnSide {
    int unit = 0;
    Side side = Side::both;
    bool low_intensity = false;  ///< Bosphorus scans of low intensity; always on both sides

    [[nodiscard]] std::string code() const;  ///< as scans spell it: "12", "12L", "12LW"
    bool operator==(const UnitOnSide&) const = default;
};

/// What a face shows: an Action Unit, several at once, an emotion, or a word of the database's own. Text becomes one of
/// these at the edge of the program; behind it nobody parses text again. Equal expressions have equal codes.
class Expression {
public:
    Expression() = default;  ///< the neutral face

    /// @param units  one or more
    [[nodiscard]] static Expression of_units(std::vector<UnitOnSide> units);
    /// An emotion, with the units of its prototype where a catalogue knows them; or any other word.
    [[nodiscard]] static Expression of_word(std::string group, std::string code, std::vector<UnitOnSide> units = {});

    [[nodiscard]] bool neutral() const { return group_ == "N"; }
    [[nodiscard]] const std::string& group() const { return group_; }  ///< Bosphorus: "LFAU", "UFAU", "CAU", "E", ...
    [[nodiscard]] const std::string& code() const { return code_; }    ///< as scans spell it: "12L", "A12A15", "HAPPY"
    [[nodiscard]] const std::string& name() const { return name_; }    ///< "AU12_L", "AU12+AU15", "HAPPY"
    [[nodiscard]] std::span<const UnitOnSide> units() const { return units_; }  ///< of a bare word: none

    /// A word of the database's own, such as "SNEER" or "CHEW-GUM": neither units nor an emotion of Bosphorus.
    [[nodiscard]] bool own_word() const { return group_ == "OTHER"; }

    /// The same Action Unit on both sides; empty if this is not one unit on one side.
    [[nodiscard]] std::optional<Expression> on_both_sides() const;

    bool operator==(const Expression& other) const { return code_ == other.code_; }

private:
    std::string group_ = "N", code_ = "N", name_ = "N";
    std::vector<UnitOnSide> units_;
};

[[nodiscard]] inline const std::string& to_string(const Expression& expression) { return expression.code(); }

/// What people write for an expression: "N", "neutral", "LFAU_12", "AU12", "AU012", "au12_L", "12L", "12LW",
/// "AU22+AU25", "A22A25", "HAPPY". What is none of these is a word of group "OTHER": ASCII letters in upper case,
/// characters that names of scans cannot have, and bytes that are no UTF-8, as '-'. Empty if nothing is left of it.
[[nodiscard]] std::optional<Expression> parse_expression(std::string_view text);

/// "12", "12L", "12R", "12LW" in any case, as the code of a scan; empty if it is none.
[[nodiscard]] std::optional<UnitOnSide> parse_unit_code(std::string_view code);
/// The units of the code of a scan: "12L", or the parts of "A12LA15". Empty if any part is no unit.
[[nodiscard]] std::vector<UnitOnSide> parse_unit_codes(std::string_view code);

/// Whether a number in the codes of a group can be an Action Unit: not where codes are words or head rotations.
[[nodiscard]] bool group_holds_units(std::string_view group);
/// "UFAU" for upper-face AUs (1, 2, 4, 5, 6, 7, 41 to 46), "LFAU" for the rest.
[[nodiscard]] std::string group_of_action_unit(int action_unit);

/// The number that a code begins with (three digits at most, as AUs have); -1 if it begins otherwise.
[[nodiscard]] int leading_number(std::string_view code);

}  // namespace mimik::facs
