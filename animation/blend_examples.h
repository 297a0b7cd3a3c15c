#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/types.h"

namespace mimik::animation {

/// Adds up displaced examples, many times a second: Eq. 14 of "Online expression mapping for performance-driven facial
/// animation" (ICEC 2007), T = T_B + sum of w_i (T_i - T_B).
class ExampleBlender {
public:
    /// @param displacements_mm  per example: one per vertex, T_i - T_B. @throws InputError where sizes differ.
    ExampleBlender(std::vector<geometry::Point> neutral_mm,
                   std::span<const std::vector<geometry::Vector>> displacements_mm);

    [[nodiscard]] std::size_t vertices() const { return neutral_mm_.size(); }
    [[nodiscard]] std::size_t examples() const { return ranges_.size(); }

    /// Weights of 0 cost nothing, and neither do vertices before the first and after the last that an example moves.
    /// @param vertices_mm  as many as the neutral face has
    /// @throws InputError where sizes differ.
    void blend(std::span<const double> weights, std::span<geometry::Point> vertices_mm) const;

private:
    struct Range {
        std::size_t first = 0, last = 0;  ///< coordinates that the example moves
        std::size_t begins = 0;           ///< of the first, in displacements_
    };
    std::vector<geometry::Point> neutral_mm_;
    std::vector<Range> ranges_;
    std::vector<double> displacements_;  ///< one example after another
};

}  // namespace mimik::animation
