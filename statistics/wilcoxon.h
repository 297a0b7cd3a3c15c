#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace mimik::statistics {

struct WilcoxonOptions {
    std::size_t exact_up_to = 50;  ///< pairs without ties; above, the normal distribution is right to 3 digits

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("exact_up_to", self.exact_up_to);
    }
};

struct SignedRanks {
    std::size_t n = 0;         ///< differences that are not 0; the others are left out (Wilcoxon 1945)
    double positive = 0;       ///< sum of the ranks of positive differences
    double negative = 0;       ///< likewise; positive + negative = n (n + 1) / 2
    std::optional<double> z;   ///< of the normal approximation; empty: the exact distribution was used
    double p = 1;              ///< two-sided
    double rank_biserial = 0;  ///< effect size, (positive - negative) / (positive + negative): -1 to 1 (Kerby 2014)
};

/// Wilcoxon's signed rank test of differences whose distribution is symmetric about 0 if there is no effect. Exact for
/// few differences without ties, else the normal approximation with its variance corrected for ties and without a
/// correction of continuity (Hollander and Wolfe 1999, section 3.1), as SciPy's.
/// @throws InputError if no difference is other than 0, or one is not finite.
[[nodiscard]] SignedRanks wilcoxon_signed_rank(std::span<const double> differences,
                                               const WilcoxonOptions& options = {});

}  // namespace mimik::statistics
