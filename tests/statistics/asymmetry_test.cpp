#include "statistics/asymmetry.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

TEST(Asymmetry, of_a_face_that_moves_alike_on_both_sides_is_zero) {
    const std::vector<double> both = {1, 2, 3};
    EXPECT_EQ(asymmetry_index(both, both).index, 0);
    EXPECT_EQ(asymmetry_index(both, both).side, 0);
}

TEST(Asymmetry, of_one_side_alone_is_one_and_says_which) {
    const std::vector<double> moved = {1, 2}, still = {0, 0};
    EXPECT_EQ(asymmetry_index(moved, still).index, 1);
    EXPECT_EQ(asymmetry_index(moved, still).side, 1);
    EXPECT_EQ(asymmetry_index(still, moved).side, -1);
}

TEST(Asymmetry, of_places_that_make_up_for_each_other_shows_in_the_index_alone) {
    const auto of = asymmetry_index(std::vector<double>{3, 1}, std::vector<double>{1, 3});
    EXPECT_EQ(of.index, 0.5);  // 2 + 2 of 8
    EXPECT_EQ(of.side, 0);
}

TEST(Asymmetry, of_nothing_or_of_what_is_no_length_is_refused) {
    EXPECT_THROW((void)asymmetry_index(std::vector<double>{0}, std::vector<double>{0}), NumericalError);
    EXPECT_THROW((void)asymmetry_index(std::vector<double>{1}, std::vector<double>{-1}), InputError);
    EXPECT_THROW((void)asymmetry_index({}, {}), InputError);
}

}  // namespace
}  // namespace mimik::statistics
