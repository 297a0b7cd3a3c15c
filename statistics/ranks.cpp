#include "statistics/ranks.h"

#include <algorithm>
#include <numeric>

namespace mimik::statistics {
namespace {

/// Calls run(order, begin, end) for each run of equal values in ascending order.
template <class Run>
void each_run(std::span<const double> values, const Run& run) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin + 1;
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        run(order, begin, end);
        begin = end;
    }
}

}  // namespace

std::vector<double> mid_ranks(std::span<const double> values) {
    std::vector<double> ranks(values.size());
    each_run(values, [&](const auto& order, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(begin + 1 + end);
    });
    return ranks;
}

std::vector<std::size_t> tie_sizes(std::span<const double> values) {
    std::vector<std::size_t> sizes;
    each_run(values, [&](const auto&, std::size_t begin, std::size_t end) {
        if (end - begin > 1) sizes.push_back(end - begin);
    });
    return sizes;
}

}  // namespace mimik::statistics
