#include "modeling/source_examples.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::modeling {
namespace {

using testing::HasSubstr;

constexpr std::string_view table =
    "example,eye_outer_left_x,eye_outer_left_y,eye_outer_left_z,chin_x,chin_y,chin_z\n"
    "neutral,45,0,0,0,-100,5\n"
    "open,45,0,0,0,-120,1\n";

std::string refusal(std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    return test::message_of([&] { (void)decode_source_examples(text, "t.csv"); });
}

TEST(SourceExamples, displacements_are_from_the_row_at_rest_and_read_back) {
    const auto source = decode_source_examples(table, "t.csv");
    EXPECT_EQ(source.features, (std::vector<std::string>{"eye_outer_left", "chin"}));
    EXPECT_EQ(source.displacement_mm[0][1], geometry::Vector(0, -20, -4));
    const auto again = decode_source_examples(encode_source_examples(source), "again");
    EXPECT_EQ(again.displacement_mm, source.displacement_mm);
    EXPECT_EQ(scaled(source, 2).displacement_mm[0][1], geometry::Vector(0, -40, -8));
}

TEST(SourceExamples, what_is_wrong_is_named) {
    const std::string text(table);
    EXPECT_THAT(refusal(text, "neutral", "rest"), HasSubstr("t.csv: line 2: the first row is 'rest'"));
    EXPECT_THAT(refusal(text, "open", "neutral"), HasSubstr("an example is called 'neutral'"));
    EXPECT_THAT(refusal(text, "chin_y", "chin_w"), HasSubstr("column 6 is 'chin_w', and 'chin_y' belongs there"));
    EXPECT_THAT(refusal(text, "-120", "-120000"), HasSubstr("example 'open': chin moves by more than 1000 mm"));
    EXPECT_THAT(refusal(text, "-120", "x"), HasSubstr("line 3: chin_y is 'x', not a finite number"));
}

TEST(SourceExamples, what_ships_has_13_or_more_examples_of_all_features_and_they_do_what_they_say) {
    const auto& standard = standard_source_examples();
    EXPECT_GE(standard.examples.size(), 13U);
    EXPECT_EQ(standard.features.size(), 48U);
    const auto moved = [&](const char* example, const char* feature) {
        return standard.displacement_mm[standard.find_example(example).value()][standard.find_feature(feature).value()];
    };
    // Directions are those of the Action Units; the sizes are what people do, within a factor of some.
    EXPECT_GT(moved("smile_left", "mouth_corner_left").x(), 2);
    EXPECT_GT(moved("smile_left", "mouth_corner_left").norm(), 3 * moved("smile_left", "mouth_corner_right").norm());
    EXPECT_LT(moved("smile_right", "mouth_corner_right").x(), -2);
    EXPECT_LT(moved("mouth_a", "lower_lip_inner").y(), -10);
    EXPECT_GT(moved("brows_up", "brow_middle_left").y(), 2);
    EXPECT_LT(moved("brows_down", "brow_inner_left").y(), -1);
    EXPECT_LT(moved("eye_closed_left", "lid_upper_outer_left").y(), -3);
    EXPECT_LT(moved("mouth_u", "mouth_corner_left").x(), -2);
    EXPECT_LT(moved("frown", "mouth_corner_left").y(), -1);
    EXPECT_GT(*outer_eye_distance_mm(standard), 70);
    EXPECT_LT(*outer_eye_distance_mm(standard), 110);
}

}  // namespace
}  // namespace mimik::modeling
