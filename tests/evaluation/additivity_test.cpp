#include "evaluation/additivity.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

using geometry::Vector;

std::vector<Vector> field(std::initializer_list<Vector> vectors) { return vectors; }
const std::vector<std::uint8_t> all_known = {1, 1, 1};

TEST(Additivity, units_that_add_up_are_off_by_nothing) {
    const auto first = field({{2, 0, 0}, {0, 0, 0}, {0, 1, 0}}), second = field({{0, 3, 0}, {0, 0, 4}, {0, 0, 0}});
    const auto whole = field({{2, 3, 0}, {0, 0, 4}, {0, 1, 0}});
    const auto one = add_up(whole, std::vector{first, second}, all_known, {});
    EXPECT_EQ(one.vertices, 3U);
    EXPECT_DOUBLE_EQ(one.motion_mm, (std::sqrt(13.0) + 4 + 1) / 3);
    EXPECT_DOUBLE_EQ(one.sum_off_mm, 0);
    EXPECT_DOUBLE_EQ(one.gain, 1);
    EXPECT_THAT(one.alone_off_mm,
                testing::ElementsAre(testing::DoubleEq((3.0 + 4 + 0) / 3), testing::DoubleEq((2.0 + 0 + 1) / 3)));
}

TEST(Additivity, an_expression_of_half_the_strength_has_half_the_gain_and_is_right_when_scaled) {
    const auto unit = field({{2, 0, 0}, {0, 4, 0}, {0, 0, 6}});
    const auto whole = field({{2, 0, 0}, {0, 4, 0}, {0, 0, 6}});
    const auto one = add_up(whole, std::vector{unit, unit}, all_known, {});
    EXPECT_DOUBLE_EQ(one.gain, 0.5);
    EXPECT_DOUBLE_EQ(one.sum_off_mm, one.motion_mm);  // twice as far as it should be
    EXPECT_NEAR(one.scaled_sum_off_mm, 0, 1e-15);
    EXPECT_NEAR(one.resultant_off_mm, 0, 1e-15);  // two equal pulls do not double
}

TEST(Additivity, vertices_that_no_scan_shows_or_that_hold_still_do_not_count) {
    const auto unit = field({{2, 0, 0}, {9, 9, 9}, {0, 0, 0.4}});
    const auto whole = field({{2, 0, 0}, {0, 0, 0}, {0, 0, 0.1}});
    const auto one = add_up(whole, std::vector{unit, field({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}})},
                            std::vector<std::uint8_t>{1, 0, 1}, {.moving_mm = 0.5});
    EXPECT_EQ(one.vertices, 1U);
    EXPECT_DOUBLE_EQ(one.sum_off_mm, 0);
}

TEST(Additivity, what_does_not_move_or_does_not_fit_is_refused) {
    const auto still = field({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    const std::vector<std::vector<Vector>> shorter = {{Vector(1, 0, 0)}};
    EXPECT_THAT(test::message_of([&] {
                    (void)add_up(still, std::vector{still, still}, all_known, {});
                }),
                testing::HasSubstr("moves by 0.5 mm"));
    EXPECT_THAT(test::message_of([&] { (void)add_up(still, shorter, all_known, {}); }),
                testing::HasSubstr("of 1 and of 3 vertices"));
    EXPECT_THROW(AdditivityOptions{.moving_mm = 0}.check(), InputError);
}

}  // namespace
}  // namespace mimik::evaluation
