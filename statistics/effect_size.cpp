#include "statistics/effect_size.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/format.h>

#include "base/errors.h"
#include "statistics/values.h"

namespace mimik::statistics {

double cohen_dz(std::span<const double> differences) {
    need_values(differences, 2, "dz");
    if (!differ(differences)) throw NumericalError("dz of differences that are all the same is not defined");
    const double mean = mean_of(differences);
    return mean / std::sqrt(squares_about(differences, mean) / static_cast<double>(differences.size() - 1));
}

double hedges_correction(double degrees) {
    if (!(degrees > 1))
        throw InputError(fmt::format("Hedges' correction for {} degrees of freedom; give more than 1", degrees));
    // Gamma(degrees / 2) over Gamma((degrees - 1) / 2), whose factors overflow.
    return 1 / (boost::math::tgamma_delta_ratio(0.5 * (degrees - 1), 0.5) * std::sqrt(0.5 * degrees));
}

double cliff_delta(std::span<const double> first, std::span<const double> second) {
    need_values(first, 1, "Cliff's delta");
    need_values(second, 1, "Cliff's delta");
    std::vector<double> sorted(second.begin(), second.end());
    std::sort(sorted.begin(), sorted.end());
    double sum = 0;  // whole numbers: exact
    for (const double value : first) {
        const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), value);
        sum += static_cast<double>((low - sorted.begin()) - (sorted.end() - high));
    }
    return sum / (static_cast<double>(first.size()) * static_cast<double>(second.size()));
}

}  // namespace mimik::statistics
