#include "statistics/false_discovery.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

TEST(FalseDiscoveryQ, three_tests_by_hand) {
    // 0.01 * 3, 0.03 * 3 / 2 and 0.04 * 3 / 3; the middle one is not above the last.
    const auto q = false_discovery_q(std::vector<double>{0.01, 0.04, 0.03});
    ASSERT_EQ(q.size(), 3U);
    EXPECT_DOUBLE_EQ(q[0], 0.03);
    EXPECT_DOUBLE_EQ(q[1], 0.04);
    EXPECT_DOUBLE_EQ(q[2], 0.04);
    const auto strict = false_discovery_q(std::vector<double>{0.01, 0.04, 0.03}, FalseDiscovery::benjamini_yekutieli);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(strict[k], q[k] * 11 / 6);  // 1 + 1/2 + 1/3
}

TEST(FalseDiscoveryQ, of_the_fifteen_tests_of_the_paper_four_are_findings) {
    // Benjamini and Hochberg 1995, section 4.1.
    const std::vector<double> p = {0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                                   0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
    const auto q = false_discovery_q(p);
    EXPECT_EQ(std::count_if(q.begin(), q.end(), [](double one) { return one <= 0.05; }), 4);
    EXPECT_EQ(q.back(), 1);
}

TEST(FalseDiscoveryQ, of_none_is_none_and_of_what_is_no_p_is_refused) {
    EXPECT_TRUE(false_discovery_q({}).empty());
    EXPECT_THROW((void)false_discovery_q(std::vector<double>{0.5, 1.5}), InputError);
}

}  // namespace
}  // namespace mimik::statistics
