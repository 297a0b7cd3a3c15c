#include "geometry/weld.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace mimik::geometry {
namespace {

std::size_t hash(const Point& position) {
    std::uint64_t h = 0x9E3779B97F4A7C15ULL;
    for (const double value : {position.x(), position.y(), position.z()}) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        h = (h ^ bits) * 0xFF51AFD7ED558CCDULL;
        h ^= h >> 32;
    }
    return h;
}

}  // namespace

std::vector<std::uint32_t> weld(std::span<const Point> vertices_mm, std::span<const Triangle> triangles) {
    std::vector<std::uint32_t> welded(vertices_mm.size(), not_welded);
    const std::size_t slots = std::bit_ceil(2 * vertices_mm.size());
    std::vector<std::uint32_t> first_at(slots, not_welded);  // open addressing, at most half full
    for (const auto& t : triangles)
        for (const auto v : t) {
            if (welded[v] != not_welded) continue;
            const Point p = vertices_mm[v] + Point::Zero();  // -0 becomes 0
            std::size_t slot = hash(p) & (slots - 1);
            while (first_at[slot] != not_welded && vertices_mm[first_at[slot]] != p) slot = (slot + 1) & (slots - 1);
            if (first_at[slot] == not_welded) first_at[slot] = v;
            welded[v] = first_at[slot];
        }
    return welded;
}

}  // namespace mimik::geometry
