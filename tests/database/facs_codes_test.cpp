#include "database/facs_codes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

using testing::HasSubstr;

TEST(FacsCodes, side_unit_and_intensity_are_read) {
    const auto codes = parse_facs_codes("title\r\n\r\nbs003_LFAU_12L_0 -> L12D + 25\r\n", "list");
    ASSERT_EQ(codes.scores.size(), 1U);
    EXPECT_THAT(codes.scores.begin()->second,
                testing::ElementsAre(FacsScore{12, facs::Side::left, 'D'}, FacsScore{25, facs::Side::both, 0}));
}

TEST(FacsCodes, zero_is_a_score_of_nothing) {
    const auto codes = parse_facs_codes("a\nb\nbs003_N_N_0 -> 0\n", "list");
    ASSERT_EQ(codes.scores.size(), 1U);
    EXPECT_TRUE(codes.scores.begin()->second.empty());
}

TEST(FacsCodes, a_line_that_is_not_understood_is_remarked_with_its_number) {
    const auto codes = parse_facs_codes("a\nb\nbs003_N_N_0 -> 0\nbs003_E_FEAR_0 -> F2\n", "list");
    EXPECT_EQ(codes.scores.size(), 1U);
    ASSERT_EQ(codes.remarks.size(), 1U);
    EXPECT_THAT(codes.remarks[0], HasSubstr("list: line 4: 'bs003_E_FEAR_0 -> F2'"));
}

TEST(FacsCodes, an_unknown_code_is_remarked_and_the_others_of_its_scan_are_kept) {
    const auto codes = parse_facs_codes("a\nb\nbs000_LFAU_12_0 -> 12D+T23B\nbs000_LFAU_9_0 -> 9B+\n", "list");
    ASSERT_EQ(codes.scores.size(), 2U);
    EXPECT_THAT(codes.scores.at(*parse_scan_name("bs000_LFAU_12_0")),
                testing::ElementsAre(FacsScore{12, facs::Side::both, 'D'}));
    EXPECT_THAT(codes.remarks, testing::ElementsAre(HasSubstr("list: line 3: code 'T23B' of bs000_LFAU_12_0 is no"),
                                                    HasSubstr("list: line 4: code '' of bs000_LFAU_9_0")));
}

TEST(FacsCodes, a_scored_scan_in_the_first_lines_is_kept_beside_an_unknown_code) {
    const auto codes = parse_facs_codes("bs000_LFAU_12_0 -> 12D+T23B\nbs000_LFAU_9_0 -> 9B\n", "list");
    ASSERT_EQ(codes.scores.size(), 2U);
    EXPECT_THAT(codes.scores.at(*parse_scan_name("bs000_LFAU_12_0")),
                testing::ElementsAre(FacsScore{12, facs::Side::both, 'D'}));
    EXPECT_THAT(codes.remarks, testing::ElementsAre(HasSubstr("list: line 1: code 'T23B' of bs000_LFAU_12_0")));
}

TEST(FacsCodes, header_lines_may_show_the_form_with_its_arrow) {
    const auto codes = parse_facs_codes("scores of -> all\nname -> code+code+...\nbs003_N_N_0 -> 0\n", "list");
    EXPECT_EQ(codes.scores.size(), 1U);
    EXPECT_TRUE(codes.remarks.empty());
    EXPECT_EQ(parse_facs_codes("bs003_N_N_0 -> 0\n", "list").scores.size(), 1U);  // without a header
}

TEST(FacsCodes, another_file_is_refused_by_name) {
    EXPECT_THAT(message_of<InputError>([] { (void)parse_facs_codes("a\nb\nc\n", "list"); }),
                HasSubstr("list: no line is of the form"));
    EXPECT_THAT(message_of<InputError>([] { (void)parse_facs_codes(std::string(200'000, '\n'), "list"); }),
                HasSubstr("list: more than 100000 lines"));
}

}  // namespace
}  // namespace mimik::database
