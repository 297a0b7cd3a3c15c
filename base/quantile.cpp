#include "base/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::base {

double median(std::vector<double> values) {
    if (values.empty()) throw InputError("a median of no value; give one or more");
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double upper_median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double quantile(std::vector<double> values, double q) {
    if (values.empty()) throw InputError("a quantile of no value; give one or more");
    if (!(q >= 0.0 && q <= 1.0)) throw InputError(fmt::format("quantile {}; give a number from 0 to 1", q));
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); }))
        throw InputError("a quantile of values that are not all numbers; leave out NaN");
    const double position = q * static_cast<double>(values.size() - 1);
    const auto lower = static_cast<std::size_t>(position);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(lower);
    std::nth_element(values.begin(), at, values.end());
    const double share = position - static_cast<double>(lower);
    if (share == 0.0) return *at;
    return *at + share * (*std::min_element(at + 1, values.end()) - *at);
}

}  // namespace mimik::base
