#include "modeling/skin_turn.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

using testing::HasSubstr;

namespace mimik::modeling {
namespace {

using geometry::Point;

constexpr double eyes_y_mm = 20, nose_y_mm = -10;

/// A curved sheet of 41 x 41 vertices, 160 mm wide, with the landmarks that say where the upper face is.
preprocessing::FaceTemplate sheet() {
    preprocessing::FaceTemplate made;
    for (int row = 0; row <= 40; ++row)
        for (int col = 0; col <= 40; ++col) {
            const double x = 4.0 * col - 80, y = 4.0 * row - 80;
            made.surface.vertices_mm.emplace_back(x, y, 50 - 0.005 * (x * x + y * y));
        }
    made.surface.landmarks =
        geometry::Landmarks(std::vector<geometry::Landmark>{{"eye_inner_left", {15, eyes_y_mm, 48}, ""},
                                                            {"eye_inner_right", {-15, eyes_y_mm, 48}, ""},
                                                            {"nose_tip", {0, nose_y_mm, 50}, ""}});
    return made;
}

std::vector<Point> turned(const std::vector<Point>& points, const Eigen::Quaterniond& turn) {
    std::vector<Point> list;
    for (const auto& p : points) list.emplace_back(turn * p + Point(3, -5, 8));
    return list;
}

TEST(SkinTurns, of_a_face_that_is_turned_as_a_whole_are_that_turn_above_the_eyes_and_none_below_the_nose) {
    const auto made = sheet();
    const auto& rest = made.surface.vertices_mm;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 0.3, -0.1).normalized()));
    const auto turns = skin_turns(made, rest, turned(rest, turn));
    ASSERT_EQ(turns.size(), rest.size());
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const double y = rest[v].y();
        // Of points that are turned exactly the fit is exact but for rounding; so is the mean of equal turns.
        if (y >= eyes_y_mm) {
            EXPECT_LT(turns[v].angularDistance(turn), 1e-7) << y;
        }
        if (y <= nose_y_mm) {
            EXPECT_EQ(turns[v].angularDistance(Eigen::Quaterniond::Identity()), 0) << y;
        }
        if (y > nose_y_mm && y < eyes_y_mm) {
            EXPECT_LT(turns[v].angularDistance(turn), 0.2) << y;
        }
    }
}

TEST(SkinTurns, follow_a_forehead_that_slopes_otherwise_and_leave_the_brow_of_an_equal_face) {
    const auto made = sheet();
    const auto& rest = made.surface.vertices_mm;
    for (const auto& turn : skin_turns(made, rest, rest))
        EXPECT_LT(turn.angularDistance(Eigen::Quaterniond::Identity()), 1e-7);
    // From y = 40 up the forehead leans back by 45 degrees more.
    auto sloping = rest;
    for (auto& p : sloping) p.z() -= std::max(0.0, p.y() - 40);
    const auto turns = skin_turns(made, rest, sloping);
    // At the top of the sheet: the slope, less what the surroundings below it, which do not lean, take away.
    const auto leans = Eigen::AngleAxisd(turns[40 * 41 + 20]);
    EXPECT_LT(leans.axis().x() * leans.angle(), -10 * std::numbers::pi / 180);
    EXPECT_GT(leans.axis().x() * leans.angle(), -45 * std::numbers::pi / 180);
    EXPECT_NEAR(leans.axis().y() * leans.angle(), 0, 0.05);  // sampled at every eighth vertex, so not quite alike
}

TEST(SkinTurns, a_template_without_the_landmarks_turns_nothing_and_other_sizes_are_refused) {
    auto made = sheet();
    const auto rest = made.surface.vertices_mm;
    const auto tilted = turned(rest, Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX())));
    EXPECT_THAT(test::message_of([&] { (void)skin_turns(made, rest, std::span(rest).first(9)); }),
                HasSubstr("1681 and 9 vertices"));
    EXPECT_THAT(test::message_of([&] { (void)skin_turns(made, rest, rest, {.width_mm = 0}); }),
                HasSubstr("width_mm is 0"));
    made.surface.landmarks = {};
    for (const auto& turn : skin_turns(made, rest, tilted))
        EXPECT_EQ(turn.angularDistance(Eigen::Quaterniond::Identity()), 0);
}

}  // namespace
}  // namespace mimik::modeling
