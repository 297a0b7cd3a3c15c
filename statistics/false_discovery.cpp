#include "statistics/false_discovery.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::statistics {

std::vector<double> false_discovery_q(std::span<const double> p, FalseDiscovery kind) {
    for (std::size_t k = 0; k < p.size(); ++k)
        if (!(p[k] >= 0 && p[k] <= 1))
            throw InputError(fmt::format("p value {} is {}; give numbers from 0 to 1", k, p[k]));
    const std::size_t n = p.size();
    double strictness = 1;
    if (kind == FalseDiscovery::benjamini_yekutieli)
        for (std::size_t k = 2; k <= n; ++k) strictness += 1 / static_cast<double>(k);
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> q(n);
    double smallest = 1;  // of those with this p or a larger one
    for (std::size_t rank = n; rank > 0; --rank) {
        const std::size_t at = order[rank - 1];
        smallest = std::min(smallest, strictness * p[at] * static_cast<double>(n) / static_cast<double>(rank));
        q[at] = smallest;
    }
    return q;
}

}  // namespace mimik::statistics
