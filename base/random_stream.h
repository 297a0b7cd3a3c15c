#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace mimik::base {

/// A seed of its own for each purpose: a hash (FNV-1a, then the SplitMix64 finaliser) of the user's seed and a path
/// such as "bs003/LFAU_12_0/noise". Turning one nuisance off or asking for further scans leaves every other draw as it
/// was.
[[nodiscard]] std::uint64_t stream_seed(std::uint64_t seed, std::string_view path);

/// Chance with transforms of its own: the standard fixes the bits of mt19937_64 but not what its distributions make of
/// them.
class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::string_view path) : engine_(stream_seed(seed, path)) {}
    explicit RandomStream(std::uint64_t seed) : engine_(seed) {}

    [[nodiscard]] double uniform();  ///< in (0, 1), never an end
    [[nodiscard]] double normal();   ///< mean 0, standard deviation 1 (Box and Muller 1958)

private:
    std::mt19937_64 engine_;
    double spare_ = 0;
    bool has_spare_ = false;
};

}  // namespace mimik::base
