#include "base/random_stream.h"

#include <cmath>

#include <gtest/gtest.h>

namespace mimik::base {
namespace {

TEST(RandomStream, streams_of_other_names_are_independent) {
    EXPECT_NE(stream_seed(1, "bs000/noise"), stream_seed(1, "bs001/noise"));
    EXPECT_NE(stream_seed(1, "bs000/noise"), stream_seed(2, "bs000/noise"));
    RandomStream a(1, "a"), b(1, "b");
    double product = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) product += a.normal() * b.normal();
    EXPECT_LT(std::abs(product / count), 0.03);  // four standard errors of 1 / sqrt(20000)
}

TEST(RandomStream, normal_draws_have_mean_0_and_deviation_1) {
    RandomStream random(7, "normal");
    double sum = 0, squares = 0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const double x = random.normal();
        sum += x;
        squares += x * x;
    }
    EXPECT_NEAR(sum / count, 0.0, 0.03);      // four standard errors
    EXPECT_NEAR(squares / count, 1.0, 0.04);  // four standard errors of sqrt(2 / 20000)
}

}  // namespace
}  // namespace mimik::base
