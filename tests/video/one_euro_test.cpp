#include "video/one_euro.h"

#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace mimik::video {
namespace {

TEST(OneEuro, what_is_constant_stays_so) {
    OneEuroFilter filter(30);
    for (int k = 0; k < 20; ++k) EXPECT_DOUBLE_EQ(filter(3.5), 3.5);
}

TEST(OneEuro, still_noise_becomes_less_and_fast_motion_lags_less_than_slow) {
    OneEuroOptions options;
    OneEuroFilter noisy(30, options);
    double in = 0, out = 0;
    for (int k = 0; k < 300; ++k) {
        const double value = k % 2 ? 0.05 : -0.05;  // too small to count as speed
        const double smooth = noisy(value);
        if (k > 30) in += value * value, out += smooth * smooth;
    }
    EXPECT_LT(std::sqrt(out / in), 0.7);
    const auto lag_s = [&](double speed) {
        OneEuroFilter filter(30, options);
        double smooth = 0;
        for (int k = 0; k < 300; ++k) smooth = filter(speed * k / 30.0);
        return (speed * 299 / 30.0 - smooth) / speed;
    };
    EXPECT_LT(lag_s(50), 0.3 * lag_s(0.1));
    EXPECT_NEAR(lag_s(0.01), 1 / (2 * EIGEN_PI * options.cutoff_hz), 0.02);  // as the header says
}

}  // namespace
}  // namespace mimik::video
