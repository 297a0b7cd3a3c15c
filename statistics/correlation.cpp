#include "statistics/correlation.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "statistics/distributions.h"
#include "statistics/ranks.h"
#include "statistics/values.h"

namespace mimik::statistics {
namespace {

void check(std::span<const double> x, std::span<const double> y, double confidence) {
    check_confidence(confidence);
    need_pairs(x, y, 3, "a correlation");
    if (!differ(x) || !differ(y))
        throw NumericalError("a correlation with values that are all the same is not defined");
}

/// @param freedom  what the error is divided by the root of; of 0 or less nothing is known
Interval fisher_interval(double value, double variance, double freedom, double confidence) {
    if (freedom <= 0) return {-1, 1};
    const double half = normal_quantile(0.5 + 0.5 * confidence) * std::sqrt(variance / freedom);
    const double z = std::atanh(value);
    return {std::tanh(z - half), std::tanh(z + half)};
}

double product_moment(std::span<const double> x, std::span<const double> y) {
    const double mean_x = mean_of(x), mean_y = mean_of(y);
    double products = 0;
    for (std::size_t k = 0; k < x.size(); ++k) products += (x[k] - mean_x) * (y[k] - mean_y);
    const double r = products / std::sqrt(squares_about(x, mean_x) * squares_about(y, mean_y));
    return std::clamp(r, -1.0, 1.0);
}

double student_p(double r, std::size_t n) {
    const auto degrees = static_cast<double>(n - 2);
    return student_two_sided_p(r * std::sqrt(degrees / ((1 - r) * (1 + r))), degrees);
}

/// What the tied values of one list take away from pairs, and add to the variance of Kendall's sum.
struct Ties {
    double pairs = 0, threes = 0, weighted = 0;
    explicit Ties(std::span<const double> values) {
        for (const std::size_t equal : tie_sizes(values)) {
            const auto t = static_cast<double>(equal);
            pairs += t * (t - 1) / 2;
            threes += t * (t - 1) * (t - 2);
            weighted += t * (t - 1) * (2 * t + 5);
        }
    }
};

/// P(as many pairs out of order as `discordant`, or as far from the half on either side), every order as likely.
double exact_kendall_p(std::size_t discordant, std::size_t n) {
    std::vector<double> share = {1.0};  // of s pairs out of order
    for (std::size_t k = 2; k <= n; ++k) {
        std::vector<double> next(share.size() + k - 1, 0.0);
        for (std::size_t s = 0; s < share.size(); ++s)
            for (std::size_t step = 0; step < k; ++step) next[s + step] += share[s] / static_cast<double>(k);
        share = std::move(next);
    }
    const std::size_t few = std::min(discordant, share.size() - 1 - discordant);
    double sum = 0;
    for (std::size_t s = 0; s <= few; ++s) sum += share[s];
    return std::min(1.0, 2 * sum);
}

}  // namespace

Correlation pearson(std::span<const double> x, std::span<const double> y, double confidence) {
    check(x, y, confidence);
    Correlation result;
    result.n = x.size();
    result.value = product_moment(x, y);
    result.p = student_p(result.value, result.n);
    result.interval = fisher_interval(result.value, 1, static_cast<double>(result.n) - 3, confidence);
    return result;
}

Correlation spearman(std::span<const double> x, std::span<const double> y, double confidence) {
    check(x, y, confidence);
    Correlation result;
    result.n = x.size();
    result.value = product_moment(mid_ranks(x), mid_ranks(y));
    result.p = student_p(result.value, result.n);
    result.interval = fisher_interval(result.value, 1 + 0.5 * result.value * result.value,
                                      static_cast<double>(result.n) - 3, confidence);
    return result;
}

Correlation kendall(std::span<const double> x, std::span<const double> y, double confidence) {
    check(x, y, confidence);
    Correlation result;
    result.n = x.size();
    std::size_t concordant = 0, discordant = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const int order_x = (x[i] > x[j]) - (x[i] < x[j]), order_y = (y[i] > y[j]) - (y[i] < y[j]);
            concordant += order_x * order_y > 0 ? 1 : 0;
            discordant += order_x * order_y < 0 ? 1 : 0;
        }
    const auto n = static_cast<double>(result.n);
    const double pairs = n * (n - 1) / 2;
    const Ties ties_x(x), ties_y(y);
    const double sum = static_cast<double>(concordant) - static_cast<double>(discordant);
    result.value = std::clamp(sum / std::sqrt((pairs - ties_x.pairs) * (pairs - ties_y.pairs)), -1.0, 1.0);
    result.exact = ties_x.pairs == 0 && ties_y.pairs == 0 && result.n <= 33;
    if (result.exact) {
        result.p = exact_kendall_p(discordant, result.n);
    } else {
        const double ordered = n * (n - 1);
        const double variance = (ordered * (2 * n + 5) - ties_x.weighted - ties_y.weighted) / 18 +
                                2 * ties_x.pairs * ties_y.pairs / ordered +
                                ties_x.threes * ties_y.threes / (9 * ordered * (n - 2));
        result.p = normal_two_sided_p(sum / std::sqrt(variance));
    }
    result.interval = fisher_interval(result.value, 0.437, n - 4, confidence);
    return result;
}

}  // namespace mimik::statistics
