#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>

#include "facs/expression.h"

namespace mimik::database {

/// Name of one scan: bs000_LFAU_12L_0 = subject "bs000", group "LFAU", code "12L", repetition 0.
/// Unknown groups and codes are kept as they are; all fields compare without regard to case.
struct ScanId {
    std::string subject;
    std::string group;
    std::string code;
    int repetition = 0;

    [[nodiscard]] std::string name() const;  ///< "bs000_LFAU_12L_0"
    [[nodiscard]] facs::Expression expression() const;
    [[nodiscard]] std::string group_and_code() const;  ///< "LFAU_12L"
    [[nodiscard]] bool neutral() const;                ///< group "N"
    /// Code in upper case without side or intensity: "12L" -> 12; "A12A15" and emotions -> empty.
    [[nodiscard]] std::optional<int> action_unit() const;
    [[nodiscard]] facs::Side side() const;     ///< from a trailing L or R of an AU code; else both
    [[nodiscard]] bool low_intensity() const;  ///< a trailing LW
    [[nodiscard]] ScanId mirrored() const;     ///< 12L <-> 12R; others unchanged

    /// By subject, neutral first, then group, code (numbers as numbers: 9 before 10), repetition.
    std::weak_ordering operator<=>(const ScanId& other) const;
    bool operator==(const ScanId& other) const { return std::is_eq(*this <=> other); }
};

/// Four fields separated by '_'; empty if the name is not of that form. No field leads to another folder: names become
/// parts of paths.
[[nodiscard]] std::optional<ScanId> parse_scan_name(std::string_view stem);
/// The same. @throws InputError showing the name that is none.
[[nodiscard]] ScanId scan_id_from(std::string_view stem);

}  // namespace mimik::database
