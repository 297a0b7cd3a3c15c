#include "animation/blend_examples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Vector;

/// 2000 vertices, more than a block; the examples move a part of them each, and one nothing.
std::vector<Point> neutral() {
    std::vector<Point> points;
    for (int v = 0; v < 2000; ++v) points.emplace_back(v, 2 * v, -v);
    return points;
}
std::vector<std::vector<Vector>> moved() {
    std::vector<std::vector<Vector>> all(4, std::vector<Vector>(2000, Vector::Zero()));
    for (int v = 0; v < 2000; ++v) all[0][static_cast<std::size_t>(v)] = {0.5, static_cast<double>(v), 1};
    for (std::size_t v = 700; v < 711; ++v) all[1][v] = {1, 2, 3};
    all[3][1999] = {0, 0, 8};
    return all;
}

TEST(BlendExamples, is_the_neutral_face_and_the_weighted_sum) {
    const ExampleBlender blender(neutral(), moved());
    std::vector<Point> out(2000);
    const std::vector<double> weights = {0.5, -2, 1, 0.25};
    blender.blend(weights, out);
    for (std::size_t v = 0; v < 2000; ++v) {
        Point expected = neutral()[v];
        for (std::size_t i = 0; i < 4; ++i) expected += weights[i] * moved()[i][v];
        ASSERT_LT((out[v] - expected).norm(), 1e-9) << v;  // sums in another order
    }
}

TEST(BlendExamples, at_an_example_is_the_example_and_at_rest_the_neutral_face_to_the_bit) {
    const ExampleBlender blender(neutral(), moved());
    std::vector<Point> out(2000);
    blender.blend(std::vector<double>{0, 0, 0, 0}, out);
    EXPECT_EQ(out, neutral());
    blender.blend(std::vector<double>{0, 1, 0, 0}, out);
    EXPECT_EQ(out[705], Point(neutral()[705] + Vector(1, 2, 3)));
    EXPECT_EQ(out[711], neutral()[711]);
}

TEST(BlendExamples, sizes_that_differ_are_refused) {
    const ExampleBlender blender(neutral(), moved());
    std::vector<Point> out(1999);
    EXPECT_THAT(test::message_of([&] { blender.blend(std::vector<double>(4), out); }),
                testing::HasSubstr("1999 vertices for 2000"));
    auto short_of_one = moved();
    short_of_one[2].pop_back();
    EXPECT_THAT(test::message_of([&] { ExampleBlender(neutral(), short_of_one); }),
                testing::HasSubstr("example 2 moves 1999 of 2000"));
}

}  // namespace
}  // namespace mimik::animation
