#include "animation/rim_motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace mimik::animation {
namespace {

using geometry::Point;

/// A flat template of 2 mm cells whose right rim has a bay: rows below 0 end at x = 0, those above at x = 10.
struct Stair {
    std::vector<Point> vertices;
    std::vector<geometry::Triangle> triangles;
    std::vector<std::uint8_t> none;

    Stair() {
        const auto index = [](int row, int col) { return static_cast<std::uint32_t>(row * 21 + col); };
        for (int row = 0; row < 21; ++row)
            for (int col = 0; col < 21; ++col) vertices.emplace_back(2.0 * col - 30, 2.0 * row - 20, 0);
        for (int row = 0; row < 20; ++row)
            for (int col = 0; col < (row < 10 ? 15 : 20); ++col) {
                triangles.push_back({index(row, col), index(row, col + 1), index(row + 1, col + 1)});
                triangles.push_back({index(row, col), index(row + 1, col + 1), index(row + 1, col)});
            }
        none.assign(vertices.size(), 0);
    }
};

/// Where the rim of the upper rows moves by 1 and that of the lower rows by 0.
double motion(const Stair& stair, const RimMotion& rim, const Point& place, double distance_mm) {
    double sum = 0;
    for (const auto& [vertex, share] : rim.shares(place, distance_mm))
        if (stair.vertices[vertex].y() > -1) sum += share;
    return sum;
}

TEST(RimMotion, shares_of_a_place_add_up_to_the_whole_motion) {
    const Stair stair;
    const RimMotion rim(stair.vertices, stair.triangles, stair.none);
    for (const double distance_mm : {0.5, 3.0, 20.0}) {
        double sum = 0;
        for (const auto& share : rim.shares(Point(10 + distance_mm, 10, 0), distance_mm)) sum += share.share;
        EXPECT_NEAR(sum, 1.0, 1e-12);  // rounding
    }
}

TEST(RimMotion, what_lies_in_a_bay_of_the_rim_moves_without_a_jump) {
    const Stair stair;
    const RimMotion rim(stair.vertices, stair.triangles, stair.none);
    // Down through the bay, 5 mm off its left side: first the rim above is nearest, then that beside. The nearest point
    // jumps by the whole motion between two steps of 0.1 mm.
    double before = motion(stair, rim, Point(5, -1, 0), 1.0), largest = 0;
    for (double y = -1.1; y > -15; y -= 0.1) {
        const double now = motion(stair, rim, Point(5, y, 0), std::min(-y, 5.0));
        largest = std::max(largest, std::abs(now - before));
        before = now;
    }
    EXPECT_LT(largest, 0.1);
    EXPECT_GT(motion(stair, rim, Point(5, -1, 0), 1.0), 0.95);   // beside the rim above: all of its motion
    EXPECT_LT(motion(stair, rim, Point(5, -15, 0), 5.0), 0.05);  // far from it: hardly any
}

TEST(RimMotion, what_is_left_out_is_no_rim) {
    const Stair stair;
    auto left_out = stair.none;
    for (std::size_t v = 0; v < left_out.size(); ++v) left_out[v] = stair.vertices[v].y() > -1 ? 1 : 0;
    const RimMotion rim(stair.vertices, stair.triangles, left_out);
    EXPECT_TRUE(rim.on_rim(0));
    EXPECT_EQ(motion(stair, rim, Point(5, -1, 0), 1.0), 0.0);
    EXPECT_FALSE(rim.on_rim(10 * 21 + 18));
}

}  // namespace
}  // namespace mimik::animation
