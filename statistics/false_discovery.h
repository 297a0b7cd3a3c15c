#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace mimik::statistics {

enum class FalseDiscovery : std::uint8_t {
    benjamini_hochberg,  ///< tests that are independent, or push each other the same way
    benjamini_yekutieli  ///< any tests; stricter by 1 + 1/2 + ... + 1/n
};
[[nodiscard]] constexpr const char* to_string(FalseDiscovery kind) {
    return kind == FalseDiscovery::benjamini_yekutieli ? "benjamini-yekutieli" : "benjamini-hochberg";
}

/// For each p the q value: the smallest false-discovery rate at which its test still counts as a finding. Who takes all
/// with q <= 0.05 is wrong in 5 % of them on average (Benjamini and Hochberg 1995; Benjamini and Yekutieli 2001).
/// @return one per p, in their order. @throws InputError for a p that is no number from 0 to 1.
[[nodiscard]] std::vector<double> false_discovery_q(std::span<const double> p,
                                                    FalseDiscovery kind = FalseDiscovery::benjamini_hochberg);

}  // namespace mimik::statistics
