#include "statistics/describe.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/quantile.h"
#include "statistics/values.h"

namespace mimik::statistics {

Description describe(std::span<const double> values) {
    need_values(values, 1, "a description");
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    Description result;
    result.n = values.size();
    result.mean = mean_of(values);
    result.median = base::median(sorted);
    if (result.n > 1) result.sd = std::sqrt(squares_about(values, result.mean) / static_cast<double>(result.n - 1));
    result.rms = std::sqrt(squares_about(values, 0) / static_cast<double>(result.n));
    result.p05 = base::quantile(sorted, 0.05);
    result.p95 = base::quantile(sorted, 0.95);
    result.min = sorted.front();
    result.max = sorted.back();
    return result;
}

}  // namespace mimik::statistics
