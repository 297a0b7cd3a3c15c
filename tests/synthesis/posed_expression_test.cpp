#include "synthesis/posed_expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::synthesis {
namespace {

using testing::HasSubstr;

TEST(Expression, smile_has_both_sides_and_its_one_sided_form_only_its_own) {
    const auto smile = make_expression("LFAU_12");
    ASSERT_EQ(smile.main_shapes.size(), 2U);
    EXPECT_EQ(smile.main_shapes[0].shape, "mouthSmile_L");
    EXPECT_DOUBLE_EQ(smile.main_shapes[0].weight, 0.70);
    const auto left = make_expression("12l");
    EXPECT_EQ(left.code, "12L");
    for (const char* spelling : {"AU12_L", "au12l", "LFAU_12L"}) EXPECT_EQ(make_expression(spelling).code, "12L");
    for (const auto& part : left.co_activated) EXPECT_TRUE(part.shape.ends_with("_L")) << part.shape;
    ASSERT_EQ(left.main_shapes.size(), 1U);
    EXPECT_EQ(left.main_shapes[0].shape, "mouthSmile_L");
}

TEST(Expression, groups_follow_the_face_half_and_lists_keep_their_order_without_doubles) {
    EXPECT_EQ(make_expression("4").group, "UFAU");
    EXPECT_EQ(make_expression("10").group, "LFAU");
    EXPECT_EQ(make_expression("10").main_shapes[0].shape, "mouthUpperUp_L");
    EXPECT_EQ(make_expression("happy").group, "E");
    const auto list = make_expressions("12,thesis,12");
    ASSERT_EQ(list.size(), 10U);
    EXPECT_EQ(list.front().code, "12");
    EXPECT_EQ(make_expressions("all").size(), 10U + 6U + 16U);
}

TEST(Expression, emotions_are_made_of_what_the_chosen_set_says) {
    const auto units = [](const PosedExpression& expression) {
        std::vector<int> numbers;
        for (const auto& [number, strength] : expression.action_units) numbers.push_back(number);
        return numbers;
    };
    using testing::ElementsAre;
    EXPECT_THAT(units(make_expression("FEAR", "thesis")), ElementsAre(1, 2, 4, 5, 20, 27));  // Table 3-3
    EXPECT_THAT(units(make_expression("ANGER", "thesis")), ElementsAre(4, 5, 7, 23, 25));
    EXPECT_THAT(units(make_expression("DISGUST", "thesis")), ElementsAre(9, 17));
    EXPECT_THAT(units(make_expression("DISGUST")), ElementsAre(9, 10, 17));
    EXPECT_EQ(make_expressions("emotions", "thesis").size(), 6U);
    EXPECT_TRUE(is_emotion_set("emfacs"));
    EXPECT_FALSE(is_emotion_set("mine"));
}

TEST(Expression, a_number_with_leading_zeros_is_the_number) {
    for (const char* spelling : {"AU04", "04", "UFAU_04"}) EXPECT_EQ(make_expression(spelling).code, "4") << spelling;
    EXPECT_EQ(make_expressions("12,012,AU012").size(), 1U);
}

TEST(Expression, a_jaw_goes_to_the_side_that_is_named_and_needs_one) {
    EXPECT_EQ(make_expression("30L").main_shapes.at(0).shape, "jawLeft");
    EXPECT_EQ(make_expression("30R").main_shapes.at(0).shape, "jawRight");
    EXPECT_EQ(make_expression("29").main_shapes.at(0).shape, "jawForward");
    try {
        (void)make_expression("30");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("30L or 30R"));
    }
}

TEST(Expression, unknown_codes_are_refused_with_the_codes_there_are) {
    try {
        (void)make_expression("LFAU_99");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("'LFAU_99'"));
        EXPECT_THAT(e.what(), HasSubstr("SURPRISE"));
    }
    for (const char* two : {"1 2", "1-2", "AU1_2"}) EXPECT_THROW((void)make_expression(two), InputError) << two;
    try {
        (void)make_expression("17L");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("has no sides"));
    }
}

TEST(PosedExpression, lids_droop_less_than_they_slit_and_a_slit_less_than_they_close) {
    const auto blink = [](const char* code) {
        double weight = 0;
        for (const auto& part : make_expression(code).main_shapes)
            if (part.shape == "eyeBlink_L") weight = part.weight;
        return weight;
    };
    EXPECT_GT(blink("41"), 0);
    EXPECT_LT(blink("41"), blink("42"));
    EXPECT_LT(blink("42"), blink("43"));
    EXPECT_EQ(blink("45"), blink("43"));
    EXPECT_EQ(blink("46L"), blink("43"));
    EXPECT_EQ(blink("46R"), 0);
}

}  // namespace
}  // namespace mimik::synthesis
