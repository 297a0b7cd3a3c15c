#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::animation {

/// One vertex of a template, and how much of its motion somebody takes.
struct MotionShare {
    std::uint32_t vertex = 0;
    double share = 0;
};

/// What lies beyond the rim of a template moves as the rim near it does. The nearest point of a rim jumps where the rim
/// bends inwards, and a surface that followed it would fold; so all of the rim that is less than two and a half times
/// as far away as the nearest has its say, the less the farther it is.
class RimMotion {
public:
    /// @param left_out  per vertex, 1: no rim, as the two sides of the cut between lips
    RimMotion(std::span<const geometry::Point> vertices_mm, std::span<const geometry::Triangle> triangles,
              std::span<const std::uint8_t> left_out);

    [[nodiscard]] bool on_rim(std::uint32_t vertex) const { return length_mm_[vertex] > 0; }
    /// Shares of the rim's vertices, sum 1; they change continuously with the place. Empty where no rim is so near.
    /// @param distance_mm  of the place from the template, above 0
    [[nodiscard]] std::vector<MotionShare> shares(const geometry::Point& place_mm, double distance_mm) const;

private:
    std::span<const geometry::Point> vertices_mm_;
    std::vector<double> length_mm_;  ///< per vertex, of the rim that is nearest to it; 0 off the rim
    std::vector<std::uint32_t> rim_;
};

}  // namespace mimik::animation
