#include "base/random_stream.h"

#include <cmath>
#include <numbers>

namespace mimik::base {

std::uint64_t stream_seed(std::uint64_t seed, std::string_view path) {
    std::uint64_t hash = 0xcbf29ce484222325ULL ^ seed;
    for (const char letter : path) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
    hash += 0x9e3779b97f4a7c15ULL;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
    return hash ^ (hash >> 31);
}

double RandomStream::uniform() {
    // 53 bits, moved off zero by half a step so that the logarithm below is finite.
    return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1.0p-53;
}

double RandomStream::normal() {
    if (has_spare_) {
        has_spare_ = false;
        return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
}

}  // namespace mimik::base
