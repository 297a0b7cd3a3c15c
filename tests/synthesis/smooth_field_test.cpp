#include "synthesis/smooth_field.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/random_stream.h"

namespace mimik::synthesis {
namespace {

TEST(SmoothField, has_unit_deviation_and_the_asked_correlation_length) {
    constexpr double length = 35.0;
    double squares = 0, products = 0;
    constexpr int fields = 4000;
    for (int f = 0; f < fields; ++f) {
        const SmoothField field(base::stream_seed(static_cast<std::uint64_t>(f), "test"), 1, length,
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
}  // namespace mimik::synthesis
