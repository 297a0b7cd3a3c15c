#include "facs/expression.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::facs {
namespace {

using test::message_of;

std::string group_and_code(const std::string& text) {
    const auto expression = parse_expression(text);
    return expression ? expression->group() + "_" + expression->code() : std::string();
}

TEST(Expression, knows_its_code_its_name_and_its_units_however_it_was_typed) {
    const auto left = *parse_expression("au12_L");
    EXPECT_EQ(left.code(), "12L");
    EXPECT_EQ(left.name(), "AU12_L");
    EXPECT_THAT(left.units(), testing::ElementsAre(UnitOnSide{12, Side::left, false}));
    const auto both = *parse_expression("A12LWA15L");
    EXPECT_EQ(both.name(), "AU12_LW+AU15_L");
    EXPECT_THAT(both.units(),
                testing::ElementsAre(UnitOnSide{12, Side::both, true}, UnitOnSide{15, Side::left, false}));
    const auto happy = *parse_expression("joy");
    EXPECT_EQ(happy.name(), "HAPPY");
    EXPECT_TRUE(happy.units().empty());
    EXPECT_TRUE(Expression().neutral());
    EXPECT_TRUE(parse_expression("neutral")->neutral());
}

TEST(Expression, an_emotion_with_units_keeps_its_own_name) {
    const auto happy = Expression::of_word("E", "HAPPY", {{6, Side::both, false}, {12, Side::both, false}});
    EXPECT_EQ(happy.name(), "HAPPY");
    EXPECT_EQ(happy.units().size(), 2U);
}

TEST(Expression, of_one_side_has_a_counterpart_on_both_and_no_other_has) {
    EXPECT_EQ(parse_expression("12L")->on_both_sides()->code(), "12");
    for (const auto* text : {"12", "12LW", "A12LA15", "HAPPY", "N"})
        EXPECT_FALSE(parse_expression(text)->on_both_sides()) << text;
}

TEST(Expression, the_usual_spellings_find_their_group_and_code) {
    const std::vector<std::pair<std::string, std::string>> spellings = {{"N", "N_N"},
                                                                        {"neutral", "N_N"},
                                                                        {"AU12", "LFAU_12"},
                                                                        {"au12_L", "LFAU_12L"},
                                                                        {"12L", "LFAU_12L"},
                                                                        {"12LW", "LFAU_12LW"},
                                                                        {"AU 4", "UFAU_4"},
                                                                        {"LFAU_12", "LFAU_12"},
                                                                        {"HAPPY", "E_HAPPY"},
                                                                        {"happiness", "E_HAPPY"},
                                                                        {"A22A25", "CAU_A22A25"},
                                                                        {"AU22+AU25", "CAU_A22A25"},
                                                                        {"YR_R10", "YR_R10"},
                                                                        {"bite lip", "OTHER_BITE-LIP"},
                                                                        {"E lips\x1d/x", "E_LIPS--X"},
                                                                        {"A1\nA2", "CAU_A1-A2"},
                                                                        {"AU01", "UFAU_1"},
                                                                        {"au04_L", "UFAU_4L"},
                                                                        {"012", "LFAU_12"},
                                                                        {"012LW", "LFAU_12LW"},
                                                                        {"LFAU_012R", "LFAU_12R"},
                                                                        {"AU01+AU04", "CAU_A1A4"},
                                                                        {"A01A04", "CAU_A1A4"},
                                                                        {"CAU_A26A012lw", "CAU_A26A12LW"},
                                                                        {"YR_R05", "YR_R05"},
                                                                        {"5", "UFAU_5"}};
    for (const auto& [text, expected] : spellings) {
        const auto id = parse_expression(text);
        ASSERT_TRUE(id) << text;
        EXPECT_EQ(id->group() + "_" + id->code(), expected) << text;
    }
    EXPECT_FALSE(parse_expression(" _ "));
}

TEST(Expression, letters_beyond_ascii_are_kept_where_they_are_utf8) {
    for (const auto& [text, expected] : {std::pair{"E_\u00e9", "E_\u00e9"},
                                         {"E_\u00fc", "E_\u00fc"},
                                         {"\u5fae\u7b11", "OTHER_\u5fae\u7b11"},
                                         {"bite \u00fc!", "OTHER_BITE-\u00fc-"},
                                         {"E_\xE9", "E_-"},                 // Latin-1
                                         {"E_\xC0\xAF", "E_--"},            // a '/' in two bytes
                                         {"E_\xED\xA0\x80", "E_---"},       // half a pair of UTF-16
                                         {"E_\xF4\x90\x80\x80", "E_----"},  // beyond the last character
                                         {"E_\xE5\xBE", "E_--"}})           // cut
        EXPECT_EQ(group_and_code(text), expected) << text;
}

TEST(ActionUnit, groups_are_those_of_the_face) {
    EXPECT_EQ(group_of_action_unit(4), "UFAU");
    EXPECT_EQ(group_of_action_unit(43), "UFAU");
    EXPECT_EQ(group_of_action_unit(9), "LFAU");
    EXPECT_EQ(group_of_action_unit(34), "LFAU");
}

TEST(Side, words_are_read_and_an_unknown_one_is_refused_by_name) {
    EXPECT_EQ(parse_side("Left"), Side::left);
    EXPECT_EQ(parse_side("r"), Side::right);
    EXPECT_THAT(message_of<InputError>([] { (void)parse_side("up"); }), testing::HasSubstr("'up'"));
}

}  // namespace
}  // namespace mimik::facs
