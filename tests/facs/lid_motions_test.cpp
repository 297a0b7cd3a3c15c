#include "facs/lid_motions.h"

#include <string>

#include <gtest/gtest.h>

#include "facs/facs_catalogue.h"

namespace mimik::facs {
namespace {

std::optional<LidMotion> of(const char* text, Side side = Side::left) {
    return lid_motion(*parse_expression(text), side);
}

TEST(LidMotions, closed_eyes_close) {
    for (const char* text : {"43", "45", "46", "43L"}) {
        const auto motion = of(text);
        ASSERT_TRUE(motion) << text;
        EXPECT_EQ(motion->upper_down + motion->lower_up, 1.0) << text;
    }
}

TEST(LidMotions, one_eye_is_one_eye) {
    EXPECT_TRUE(of("43L", Side::left));
    EXPECT_FALSE(of("43L", Side::right));
    EXPECT_FALSE(of("46R", Side::left));
}

TEST(LidMotions, add_up_to_closed_eyes) {
    const auto motion = of("AU7+AU43");
    ASSERT_TRUE(motion);
    EXPECT_DOUBLE_EQ(motion->upper_down + motion->lower_up, 1.0);
    EXPECT_GT(motion->lower_up, of("43")->lower_up);
    EXPECT_LT(of("5")->upper_down, 0.0);
}

TEST(LidMotions, of_other_units_emotions_and_low_intensity_are_not_known) {
    EXPECT_FALSE(of("12"));
    EXPECT_FALSE(of("6"));
    EXPECT_FALSE(of("43LW"));
    EXPECT_FALSE(lid_motion(builtin_catalogue().expression("FEAR"), Side::left));
}

TEST(LidMotions, say_where_they_come_from) {
    for (const auto& unit : lid_units()) EXPECT_NE(std::string(unit.source).find("FACS"), std::string::npos);
}

}  // namespace
}  // namespace mimik::facs
