#include "statistics/clusters.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

void check_lengths(std::size_t first, std::size_t second) {
    if (first != second)
        throw InputError(fmt::format("clusters of {} cases and {} cases; give two subjects per case", first, second));
}

}  // namespace

DenseIds dense_ids(std::span<const std::uint32_t> ids) {
    std::vector<std::uint32_t> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    DenseIds dense;
    dense.count = sorted.size();
    dense.of_case.reserve(ids.size());
    for (const std::uint32_t id : ids)
        dense.of_case.push_back(
            static_cast<std::uint32_t>(std::lower_bound(sorted.begin(), sorted.end(), id) - sorted.begin()));
    return dense;
}

Clusters Clusters::one_way(std::span<const std::uint32_t> subject) {
    Clusters clusters;
    auto ids = dense_ids(subject);
    clusters.draws_ = {ids.count};
    clusters.first_ = std::move(ids.of_case);
    return clusters;
}

Clusters Clusters::two_way(std::span<const std::uint32_t> first, std::span<const std::uint32_t> second) {
    check_lengths(first.size(), second.size());
    Clusters clusters = one_way(first);
    auto ids = dense_ids(second);
    clusters.draws_.push_back(ids.count);
    clusters.second_ = std::move(ids.of_case);
    clusters.second_draw_ = 1;
    return clusters;
}

Clusters Clusters::pairs_of_people(std::span<const std::uint32_t> source, std::span<const std::uint32_t> target) {
    check_lengths(source.size(), target.size());
    std::vector<std::uint32_t> both(source.begin(), source.end());
    both.insert(both.end(), target.begin(), target.end());
    const auto ids = dense_ids(both);
    const auto middle = ids.of_case.begin() + static_cast<std::ptrdiff_t>(source.size());
    Clusters clusters;
    clusters.draws_ = {ids.count};
    clusters.first_.assign(ids.of_case.begin(), middle);
    clusters.second_.assign(middle, ids.of_case.end());
    return clusters;
}

void Clusters::weigh(std::span<const std::vector<double>> counts, std::span<double> weights) const {
    const auto& first = counts[0];
    if (second_.empty()) {
        for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = first[first_[k]];
        return;
    }
    const auto& second = counts[second_draw_];
    for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = first[first_[k]] * second[second_[k]];
}

}  // namespace mimik::statistics
