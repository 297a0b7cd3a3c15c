#include "statistics/intraclass.h"

#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "statistics/distributions.h"
#include "statistics/values.h"

namespace mimik::statistics {
namespace {

struct MeanSquares {
    double things = 0, raters = 0, residual = 0;
};

MeanSquares mean_squares(std::span<const double> values, std::size_t raters) {
    const std::size_t things = values.size() / raters;
    const auto n = static_cast<double>(things), k = static_cast<double>(raters);
    const double mean = mean_of(values);
    std::vector<double> thing(things, 0.0), rater(raters, 0.0);
    for (std::size_t at = 0; at < values.size(); ++at) {
        thing[at / raters] += values[at] / k;
        rater[at % raters] += values[at] / n;
    }
    std::vector<double> residual(values.size());
    for (std::size_t at = 0; at < values.size(); ++at)
        residual[at] = values[at] - thing[at / raters] - rater[at % raters] + mean;
    MeanSquares squares;
    squares.things = k * squares_about(thing, mean) / (n - 1);
    squares.raters = n * squares_about(rater, mean) / (k - 1);
    squares.residual = squares_about(residual, 0) / (n - 1) / (k - 1);
    return squares;
}

}  // namespace

Intraclass intraclass(std::span<const double> values, std::size_t raters, double confidence) {
    check_confidence(confidence);
    if (raters < 2 || values.size() % raters != 0 || values.size() / raters < 2)
        throw InputError(
            fmt::format("an intraclass correlation of {} values by {} raters; give 2 raters or more, and a "
                        "value of each for 2 things or more",
                        values.size(), raters));
    need_values(values, 4, "an intraclass correlation");
    const auto k = static_cast<double>(raters), n = static_cast<double>(values.size() / raters);
    const auto [things, judges, residual] = mean_squares(values, raters);
    if (!(residual > 1e-24 * squares_about(values, 0)))  // squares of what rounding leaves
        throw NumericalError("an intraclass correlation of values without a residual has no F");
    Intraclass result;
    result.value = (things - residual) / (things + (k - 1) * residual + k * (judges - residual) / n);
    result.f = things / residual;
    result.p = fisher_above(result.f, n - 1, (n - 1) * (k - 1));
    // Satterthwaite's degrees of freedom of what the raters and the residual are together.
    const double of_raters = k * result.value * judges / residual;
    const double of_residual = n * (1 + (k - 1) * result.value) - k * result.value;
    const double degrees = (k - 1) * (n - 1) * (of_raters + of_residual) * (of_raters + of_residual) /
                           ((n - 1) * of_raters * of_raters + of_residual * of_residual);
    const double share = 0.5 + 0.5 * confidence;
    const double f_low = fisher_quantile(share, n - 1, degrees), f_high = fisher_quantile(share, degrees, n - 1);
    const double others = k * judges + (k * n - k - n) * residual;
    result.interval = {n * (things - f_low * residual) / (f_low * others + n * things),
                       n * (f_high * things - residual) / (others + n * f_high * things)};
    return result;
}

}  // namespace mimik::statistics
