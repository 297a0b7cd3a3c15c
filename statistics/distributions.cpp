#include "statistics/distributions.h"

#include <cmath>
#include <limits>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

namespace math = boost::math;

constexpr double infinite = std::numeric_limits<double>::infinity();

void check_share(double share) {
    if (!(share >= 0 && share <= 1))
        throw InputError(fmt::format("the quantile of share {}; give a number from 0 to 1", share));
}

}  // namespace

double normal_below(double z) {
    if (std::isinf(z)) return z > 0 ? 1 : 0;
    return math::cdf(math::normal_distribution<>(), z);
}

double normal_quantile(double share) {
    check_share(share);
    if (share == 0 || share == 1) return share == 0 ? -infinite : infinite;
    return math::quantile(math::normal_distribution<>(), share);
}

double normal_two_sided_p(double z) { return 2 * normal_below(-std::abs(z)); }

double student_quantile(double share, double degrees) {
    check_share(share);
    if (share == 0 || share == 1) return share == 0 ? -infinite : infinite;
    return math::quantile(math::students_t_distribution<>(degrees), share);
}

double student_two_sided_p(double t, double degrees) {
    if (std::isinf(t)) return 0;
    return 2 * math::cdf(math::students_t_distribution<>(degrees), -std::abs(t));
}

double fisher_above(double f, double degrees, double other_degrees) {
    if (std::isinf(f)) return 0;
    return math::cdf(math::complement(math::fisher_f_distribution<>(degrees, other_degrees), f));
}

double fisher_quantile(double share, double degrees, double other_degrees) {
    check_share(share);
    if (share == 0 || share == 1) return share == 0 ? 0 : infinite;
    return math::quantile(math::fisher_f_distribution<>(degrees, other_degrees), share);
}

}  // namespace mimik::statistics
