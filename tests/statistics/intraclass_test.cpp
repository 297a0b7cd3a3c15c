#include "statistics/intraclass.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

TEST(Intraclass, of_four_judges_is_what_shrout_and_fleiss_print) {
    // Shrout and Fleiss 1979, tables 2 to 4: mean squares 11.24 and 1.02, ICC(2,1) = 0.29; the interval as R's psych
    // has it.
    const std::vector<double> judged = {9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7};
    const auto icc = intraclass(judged, 4);
    EXPECT_NEAR(icc.value, 0.2898, 5e-5);
    EXPECT_NEAR(icc.f, 11.03, 5e-3);
    EXPECT_NEAR(icc.p, 0.000135, 5e-7);
    EXPECT_NEAR(icc.interval.low, 0.0188, 5e-5);
    EXPECT_NEAR(icc.interval.high, 0.7611, 5e-5);
}

TEST(Intraclass, says_what_it_cannot_do) {
    EXPECT_THROW((void)intraclass(std::vector<double>{1, 2, 3}, 2), InputError);
    EXPECT_THROW((void)intraclass(std::vector<double>{1, 2, 3, 4}, 1), InputError);
    EXPECT_THROW((void)intraclass(std::vector<double>{0.1, 0.3, 0.2, 0.4, 0.7, 0.9}, 2), NumericalError);
}

}  // namespace
}  // namespace mimik::statistics
