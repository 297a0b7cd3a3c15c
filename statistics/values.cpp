#include "statistics/values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::statistics {

void need_values(std::span<const double> values, std::size_t fewest, std::string_view what) {
    if (values.size() < fewest)
        throw InputError(fmt::format("{} of {} values; give {} or more", what, values.size(), fewest));
    const auto odd = std::find_if_not(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
    if (odd != values.end())
        throw InputError(
            fmt::format("{}: value {} is {}; leave out what is not known", what, odd - values.begin(), *odd));
}

void need_pairs(std::span<const double> first, std::span<const double> second, std::size_t fewest,
                std::string_view what) {
    if (first.size() != second.size())
        throw InputError(fmt::format("{}: {} values beside {}; give pairs", what, first.size(), second.size()));
    need_values(first, fewest, what);
    need_values(second, fewest, what);
}

bool differ(std::span<const double> values) {
    if (values.empty()) return false;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    // What is left of equal values after one subtraction each.
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(*low), std::abs(*high));
    return *high - *low > rounding;
}

double mean_of(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double squares_about(std::span<const double> values, double mean) {
    double sum = 0;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return sum;
}

}  // namespace mimik::statistics
