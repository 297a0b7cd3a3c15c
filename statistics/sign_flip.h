#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mimik::statistics {

struct SignFlipOptions {
    std::uint64_t seed = 1;
    int resamples = 10000;  ///< where not all signs are tried; p is then known to 0.002 at 0.05
    int exact_up_to = 16;   ///< clusters: 65,536 arrangements

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("seed", self.seed);
        visit("resamples", self.resamples);
        visit("exact_up_to", self.exact_up_to);
    }
    void check() const;  ///< throws InputError
};

struct SignFlip {
    double mean = 0;  ///< of the differences
    double p = 1;     ///< two-sided
    std::size_t clusters = 0;
    std::size_t arrangements = 0;  ///< tried
    bool exact = false;            ///< all there are
};

/// A permutation test of paired differences: if there is no effect, a subject's differences could as well have had the
/// other sign, all of them together (Fisher 1935; Winkler et al. 2014 for exchange by blocks). p is the share of signs
/// of the clusters with which the mean is as far from 0, or farther: of all signs, or (b + 1) / (n + 1) of n drawn ones
/// (Phipson and Smyth 2010). Means that differ by rounding are as far.
/// @param cluster  per difference: any number that stands for its subject
/// @throws InputError of no difference, one that is not finite, if the lists differ in length, or for bad options.
[[nodiscard]] SignFlip sign_flip_test(std::span<const double> differences, std::span<const std::uint32_t> cluster,
                                      const SignFlipOptions& options = {});

}  // namespace mimik::statistics
