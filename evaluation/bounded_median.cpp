#include "evaluation/bounded_median.h"

#include <algorithm>
#include <cmath>

namespace mimik::evaluation {

void BoundedMedian::add(double value) {
    ++size_;
    if (counts_.empty() && values_.size() < exact_values) {
        values_.push_back(value);
        return;
    }
    if (counts_.empty()) {
        counts_.assign(static_cast<std::size_t>(std::lround((high - low) / step)), 0);
        for (const double earlier : values_) count(earlier);
        values_ = {};
    }
    count(value);
}

void BoundedMedian::count(double value) {
    const double place = std::clamp((value - low) / step, 0.0, static_cast<double>(counts_.size()) - 1);
    ++counts_[static_cast<std::size_t>(place)];
}

double BoundedMedian::counted(std::uint64_t rank) const {
    std::size_t k = 0;
    for (std::uint64_t below = counts_[0]; below <= rank; below += counts_[k]) ++k;
    return low + (static_cast<double>(k) + 0.5) * step;
}

double BoundedMedian::median() const {
    if (size_ == 0) return 0;
    if (!counts_.empty()) return size_ % 2 ? counted(size_ / 2) : 0.5 * (counted(size_ / 2 - 1) + counted(size_ / 2));
    auto sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

}  // namespace mimik::evaluation
