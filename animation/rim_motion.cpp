#include "animation/rim_motion.h"

#include "geometry/topology.h"

namespace mimik::animation {

using geometry::Point;

RimMotion::RimMotion(std::span<const Point> vertices_mm, std::span<const geometry::Triangle> triangles,
                     std::span<const std::uint8_t> left_out)
    : vertices_mm_(vertices_mm), length_mm_(vertices_mm.size(), 0.0) {
    for (const auto& [a, b] : geometry::border_edges(triangles)) {
        if (left_out[a] && left_out[b]) continue;
        const double half_mm = (vertices_mm[a] - vertices_mm[b]).norm() / 2;
        for (const auto v : {a, b})
            if (!left_out[v]) length_mm_[v] += half_mm;
    }
    for (std::uint32_t v = 0; v < length_mm_.size(); ++v)
        if (length_mm_[v] > 0) rim_.push_back(v);
}

std::vector<MotionShare> RimMotion::shares(const Point& place_mm, double distance_mm) const {
    constexpr double reach = 2.5;  // times the distance: over a stair of the rim, not around the chin
    std::vector<MotionShare> shares;
    double sum = 0;
    for (const auto v : rim_) {
        const double farther = (vertices_mm_[v] - place_mm).norm() / distance_mm - 1;
        const double t = 1 - farther / (reach - 1);
        if (t <= 0) continue;
        shares.push_back({v, length_mm_[v] * t * t});
        sum += shares.back().share;
    }
    for (auto& share : shares) share.share /= sum;
    return shares;
}

}  // namespace mimik::animation
