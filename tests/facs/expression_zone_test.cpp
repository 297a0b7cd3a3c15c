#include "facs/expression_zone.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "facs/reference_face.h"
#include "tests/support/expressions.h"

namespace mimik::facs {
namespace {

using testing::HasSubstr;

TEST(Placement, of_a_landmark_is_that_landmark_on_the_side_asked_for) {
    const Placement corner{{{"mouth_corner", 1.0}}, 0, 0};
    EXPECT_EQ(place(corner, reference_landmarks(), Side::left), reference_landmarks().position_mm("mouth_corner_left"));
    EXPECT_EQ(place(corner, reference_landmarks(), Side::right),
              reference_landmarks().position_mm("mouth_corner_right"));
}

TEST(Placement, offsets_are_outer_eye_distances_away_from_the_midline) {
    const Placement beside{{{"mouth_corner", 1.0}}, 0.1, -0.2};
    const double unit = 89.0;  // of the reference face: eye corners at -44.5 and 44.5 mm, same height and depth
    const auto left = place(beside, reference_landmarks(), Side::left),
               right = place(beside, reference_landmarks(), Side::right);
    EXPECT_NEAR(left.x(), 25.5 + 0.1 * unit, 1e-9);
    EXPECT_NEAR(right.x(), -25.5 - 0.1 * unit, 1e-9);
    EXPECT_NEAR(left.y(), -39 - 0.2 * unit, 1e-9);
}

TEST(Placement, misses_no_landmark_in_silence) {
    const geometry::Landmarks few({{"eye_outer_left", {44, 0, 0}, ""}, {"eye_outer_right", {-44, 0, 0}, ""}});
    try {
        (void)place({{{"chin", 1.0}}, 0, 0}, few, Side::left);
        FAIL() << "placed";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("chin"));
    }
}

TEST(ExpressionZone, holds_the_part_that_moves_and_not_the_rest) {
    const auto inside = [](const std::string& code, const std::string& mark) {
        return ExpressionZone(builtin_catalogue(), test::expression(code), reference_landmarks())
                   .distance(reference_landmarks().position_mm(mark)) <= 0;
    };
    EXPECT_TRUE(inside("12", "mouth_corner_left"));
    EXPECT_TRUE(inside("12", "mouth_corner_right"));
    EXPECT_FALSE(inside("12L", "mouth_corner_right"));
    EXPECT_FALSE(inside("12", "brow_middle_left"));
    EXPECT_TRUE(inside("1", "brow_inner_left"));
    EXPECT_FALSE(inside("1", "chin"));
    EXPECT_TRUE(inside("17", "chin"));
    EXPECT_FALSE(inside("17", "nose_tip"));
}

}  // namespace
}  // namespace mimik::facs
