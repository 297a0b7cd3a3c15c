#include "video/one_euro.h"

#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::video {
namespace {
/// Share of the new value in a low pass of first order.
double share(double cutoff_hz, double rate_hz) {
    const double turn = 2 * EIGEN_PI * cutoff_hz / rate_hz;
    return turn / (turn + 1);
}
}  // namespace

void OneEuroOptions::check() const {
    if (!(cutoff_hz > 0)) throw InputError(fmt::format("cutoff_hz is {}; give more than 0", cutoff_hz));
    if (!(speed >= 0)) throw InputError(fmt::format("speed is {}; give 0 or more", speed));
    if (!(speed_cutoff_hz > 0))
        throw InputError(fmt::format("speed_cutoff_hz is {}; give more than 0", speed_cutoff_hz));
}

OneEuroFilter::OneEuroFilter(double rate_hz, const OneEuroOptions& options) : rate_hz_(rate_hz), options_(options) {
    options_.check();
    if (!(rate_hz > 0)) throw InputError(fmt::format("the rate is {} Hz; give more than 0", rate_hz));
}

double OneEuroFilter::operator()(double value) {
    if (!started_) {
        started_ = true;
        speed_ = 0;
        return last_ = smooth_ = value;
    }
    speed_ += share(options_.speed_cutoff_hz, rate_hz_) * ((value - last_) * rate_hz_ - speed_);
    last_ = value;
    const double cutoff_hz = options_.cutoff_hz + options_.speed * std::abs(speed_);
    return smooth_ += share(cutoff_hz, rate_hz_) * (value - smooth_);
}

}  // namespace mimik::video
