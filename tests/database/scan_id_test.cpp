#include "database/scan_id.h"

#include <algorithm>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/database/temporary_folder.h"

namespace mimik::database {
namespace {

TEST(ScanName, four_fields_are_read_and_written_back) {
    for (const char* name : {"bs000_LFAU_12L_0", "bs104_CAU_A26A12lw_0", "bs001_E_HAPPY_1", "bs007_XYZ_new_3"}) {
        const auto id = parse_scan_name(name);
        ASSERT_TRUE(id) << name;
        EXPECT_EQ(id->name(), name);
    }
}

TEST(ScanName, other_names_are_no_scan_names) {
    for (const char* name : {"", "bs000", "bs000_N_N", "bs000_N_N_x", "bs000_N_N_0_1", "_N_N_0", "bs000__N_0",
                             "bs000_N_N_", "bs000_N_N_99999999999"})
        EXPECT_FALSE(parse_scan_name(name)) << name;
}

TEST(ScanName, no_name_leads_to_another_folder) {
    for (const char* name : {"../bs000_N_N_0", ".._N_N_0", "a/b_N_N_0", "a\\b_N_N_0", "bs000_N_../x_0", "a\n_N_N_0"}) {
        EXPECT_FALSE(parse_scan_name(name)) << name;
        EXPECT_THROW((void)scan_id_from(name), InputError) << name;
    }
}

TEST(ScanName, action_unit_side_and_intensity_come_from_the_code) {
    const auto left = *parse_scan_name("bs000_LFAU_12L_0");
    EXPECT_EQ(left.action_unit(), 12);
    EXPECT_EQ(left.side(), facs::Side::left);
    EXPECT_EQ(parse_scan_name("bs000_LFAU_12R_0")->side(), facs::Side::right);
    const auto low = *parse_scan_name("bs000_LFAU_12LW_0");
    EXPECT_EQ(low.action_unit(), 12);
    EXPECT_EQ(low.side(), facs::Side::both);
    EXPECT_TRUE(low.low_intensity());
    EXPECT_TRUE(parse_scan_name("bs000_CAU_A26A12lw_0")->low_intensity());
    EXPECT_FALSE(left.low_intensity());
}

TEST(ScanName, words_rotations_and_combinations_are_no_action_unit) {
    for (const char* name : {"bs000_N_N_0", "bs000_E_HAPPY_0", "bs000_YR_R10_0", "bs000_CAU_A12A15_0", "bs000_O_EYE_0",
                             "bs000_IGN_12_0", "bs000_LFAU_1234_0"})
        EXPECT_EQ(parse_scan_name(name)->action_unit(), std::nullopt) << name;
}

TEST(ScanName, compares_without_regard_to_case) {
    EXPECT_EQ(*parse_scan_name("bs000_CAU_A26A12lw_0"), *parse_scan_name("BS000_cau_A26A12LW_0"));
    EXPECT_NE(*parse_scan_name("bs000_LFAU_12_0"), *parse_scan_name("bs000_LFAU_12L_0"));
}

TEST(ScanName, sorts_by_subject_then_neutral_first_then_numbers_as_numbers) {
    std::vector<std::string> names = {"bs001_N_N_0",      "bs000_LFAU_12_0", "bs000_LFAU_9_0", "bs000_N_N_1",
                                      "bs000_LFAU_12L_0", "bs000_E_FEAR_0",  "bs000_N_N_0"};
    std::sort(names.begin(), names.end(),
              [](const auto& a, const auto& b) { return *parse_scan_name(a) < *parse_scan_name(b); });
    EXPECT_THAT(names, testing::ElementsAre("bs000_N_N_0", "bs000_N_N_1", "bs000_E_FEAR_0", "bs000_LFAU_9_0",
                                            "bs000_LFAU_12_0", "bs000_LFAU_12L_0", "bs001_N_N_0"));
}

TEST(ScanName, mirroring_swaps_one_sided_codes_only) {
    EXPECT_EQ(parse_scan_name("bs000_LFAU_12L_0")->mirrored().name(), "bs000_LFAU_12R_0");
    EXPECT_EQ(parse_scan_name("bs000_LFAU_12r_0")->mirrored().name(), "bs000_LFAU_12l_0");
    EXPECT_EQ(parse_scan_name("bs000_LFAU_12LW_0")->mirrored().name(), "bs000_LFAU_12LW_0");
    EXPECT_EQ(parse_scan_name("bs000_YR_L90_0")->mirrored().name(), "bs000_YR_L90_0");
}

}  // namespace
}  // namespace mimik::database
