#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mimik::geometry {

/// A node of SurfaceIndex's tree: the boxes of up to eight children, in single precision and rounded outwards. Unused
/// children have an empty box (low > high, infinite), which is infinitely far from everything.
struct alignas(32) BoxNode {
    static constexpr std::size_t width = 8;
    std::array<std::array<float, width>, 3> low;
    std::array<std::array<float, width>, 3> high;
    std::array<std::uint32_t, width> child;  ///< a node, or in a leaf a triangle
    bool leaf = false;
};

/// Squared distances from a query, known to lie between `query_low` and `query_high`, to the boxes of a node: never
/// above the true ones. Bit k of the answer: child k is not farther than `limit`.
using BoxDistances = std::uint32_t (*)(const BoxNode& node, const float* query_low, const float* query_high,
                                       float limit, float* squared);
/// The variant for this machine's vector unit. All variants agree within the rounding that the outward margin covers.
[[nodiscard]] BoxDistances box_distances();

}  // namespace mimik::geometry
