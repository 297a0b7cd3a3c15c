#include "base/random_stream.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "synthesis/smooth_field.h"

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

TEST(SmoothField, has_unit_deviation_and_the_asked_correlation_length) {
    constexpr double length = 35.0;
    double squares = 0, products = 0;
    constexpr int fields = 4000;
    for (int f = 0; f < fields; ++f) {
        const SmoothField field(stream_seed(static_cast<std::uint64_t>(f), "test"), 1, length,
                                geometry::Point::Constant(-100), geometry::Point::Constant(100));
        const double a = field.at({3, -7, 11})[0], b = field.at({3 + length, -7, 11})[0];
        squares += a * a;
        products += a * b;
    }
    EXPECT_NEAR(squares / fields, 1.0, 0.1);               // four standard errors
    EXPECT_NEAR(products / fields, std::exp(-0.5), 0.09);  // four standard errors and 0.02 of the spline's own
}

TEST(SmoothField, refuses_a_length_of_zero_by_name) {
    try {
        const SmoothField field(1, 1, 0.0, geometry::Point::Zero(), geometry::Point::Ones());
        FAIL();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("correlation length"), std::string::npos);
    }
}

}  // namespace
}  // namespace mimik::base
