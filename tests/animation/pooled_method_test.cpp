#include "animation/pooled_method.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "preprocessing/face_template.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Vector;

const std::vector<Point> target = {{0, 0, 0}, {10, 0, 0}};
const std::vector<Point> same = target;
const std::vector<Point> off_by_2 = {{0, 0, 2}, {10, 0, 2}};
const std::vector<Point> off_by_4 = {{0, 4, 0}, {10, 4, 0}};

std::vector<Vector> motion(double up) { return {{0, up, 0}, {0, 2 * up, 0}}; }

TEST(PooledMotion, faces_like_the_targets_weigh_as_the_formula_says) {
    const preprocessing::FaceTemplate nothing;
    const auto first = motion(1), second = motion(2), third = motion(4);
    const std::vector<PooledSource> sources = {{same, first}, {off_by_2, second}, {off_by_4, third}};
    const auto pooled = near_motion(sources, {nothing, true, target});
    // Distances 0, 2, 4, of which the median is 2: weights 1, exp(-1/2), exp(-2).
    const double w1 = std::exp(-0.5), w2 = std::exp(-2.0);
    const double expected = (1 + 2 * w1 + 4 * w2) / (1 + w1 + w2);
    EXPECT_NEAR(pooled[0].y(), expected, 1e-12);
    EXPECT_NEAR(pooled[1].y(), 2 * expected, 1e-12);
    // Of two faces the median lies half way: 2.
    const auto of_two =
        near_motion(std::vector<PooledSource>{{same, first}, {off_by_4, third}}, {nothing, true, target});
    EXPECT_NEAR(of_two[0].y(), (1 + 4 * w2) / (1 + w2), 1e-12);
}

TEST(PooledMotion, of_one_source_is_its_own_and_of_equal_faces_the_mean) {
    const preprocessing::FaceTemplate nothing;
    const auto first = motion(1), second = motion(2);
    EXPECT_NEAR(near_motion(std::vector<PooledSource>{{off_by_2, second}}, {nothing, true, target})[0].y(), 2, 1e-12);
    const std::vector<PooledSource> equal = {{same, first}, {same, second}};
    EXPECT_NEAR(near_motion(equal, {nothing, true, target})[0].y(), 1.5, 1e-12);
}

TEST(PooledMotion, is_made_symmetric_by_its_mirror_image) {
    preprocessing::FaceTemplate made;
    made.mirror = {1, 0, 2};  // two vertices that mirror each other, and one on the mid-line
    const std::vector<Vector> one_sided = {{2, 4, 0}, {0, 0, 0}, {1, 3, 5}};
    const auto both = symmetric_motion(made, one_sided);
    EXPECT_EQ(both[0], Vector(1, 2, 0));
    EXPECT_EQ(both[1], Vector(-1, 2, 0));
    EXPECT_EQ(both[2], Vector(0, 3, 5));  // nothing moves sideways on the mid-line
}

}  // namespace
}  // namespace mimik::animation
