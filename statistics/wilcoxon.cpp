#include "statistics/wilcoxon.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/errors.h"
#include "statistics/distributions.h"
#include "statistics/ranks.h"
#include "statistics/values.h"

namespace mimik::statistics {
namespace {

/// P(sum of ranks <= w), where each of the ranks 1 ... n counts or not by the toss of a coin.
double rank_sum_at_most(std::size_t w, std::size_t n) {
    std::vector<double> share = {1.0};  // of sum s
    for (std::size_t rank = 1; rank <= n; ++rank) {
        std::vector<double> next(share.size() + rank, 0.0);
        for (std::size_t s = 0; s < share.size(); ++s) {
            next[s] += 0.5 * share[s];
            next[s + rank] += 0.5 * share[s];
        }
        share = std::move(next);
    }
    double sum = 0;
    for (std::size_t s = 0; s <= w && s < share.size(); ++s) sum += share[s];
    return sum;
}

}  // namespace

SignedRanks wilcoxon_signed_rank(std::span<const double> differences, const WilcoxonOptions& options) {
    need_values(differences, 1, "a signed rank test");
    std::vector<double> size;
    std::vector<char> is_positive;
    for (const double difference : differences) {
        if (difference == 0) continue;
        size.push_back(std::abs(difference));
        is_positive.push_back(difference > 0);
    }
    if (size.empty()) throw InputError("a signed rank test of differences that are all 0; give one that is not");
    SignedRanks result;
    result.n = size.size();
    const auto ranks = mid_ranks(size);
    for (std::size_t k = 0; k < ranks.size(); ++k) (is_positive[k] ? result.positive : result.negative) += ranks[k];
    result.rank_biserial = (result.positive - result.negative) / (result.positive + result.negative);
    const auto ties = tie_sizes(size);
    if (ties.empty() && result.n <= options.exact_up_to) {
        const auto smaller = static_cast<std::size_t>(std::llround(std::min(result.positive, result.negative)));
        result.p = std::min(1.0, 2 * rank_sum_at_most(smaller, result.n));
        return result;
    }
    const auto n = static_cast<double>(result.n);
    double variance = n * (n + 1) * (2 * n + 1) / 24;
    for (const std::size_t equal : ties) {
        const auto t = static_cast<double>(equal);
        variance -= t * (t * t - 1) / 48;
    }
    result.z = (result.positive - n * (n + 1) / 4) / std::sqrt(variance);
    result.p = normal_two_sided_p(*result.z);
    return result;
}

}  // namespace mimik::statistics
