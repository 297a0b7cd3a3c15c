#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace mimik::database {

enum class Side { both, left, right };  ///< the subject's own

/// Name of one scan: bs000_LFAU_12L_0 = subject "bs000", group "LFAU", code "12L", repetition 0.
/// Unknown groups and codes are kept as they are; codes compare without regard to case.
struct ScanId {
    std::string subject;
    std::string group;
    std::string code;
    int repetition = 0;

    [[nodiscard]] std::string name() const;  ///< "bs000_LFAU_12L_0"
    [[nodiscard]] bool neutral() const;      ///< group "N"
    /// Code in upper case without side or intensity: "12L" -> 12; "A12A15" and emotions -> empty.
    [[nodiscard]] std::optional<int> action_unit() const;
    [[nodiscard]] Side side() const;        ///< from a trailing L or R of an AU code; else both
    [[nodiscard]] bool low_intensity() const;  ///< a trailing LW
    auto operator<=>(const ScanId&) const = default;
};

/// Four fields separated by '_'; empty if the name is not of that form.
[[nodiscard]] std::optional<ScanId> parse_scan_name(std::string_view stem);

/// "UFAU" for upper-face AUs (1, 2, 4, 5, 6, 7, 43, 44 ...), "LFAU" for the rest.
[[nodiscard]] std::string group_of_action_unit(int action_unit);

}  // namespace mimik::database
