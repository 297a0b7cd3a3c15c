#include "statistics/sign_flip.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/random_stream.h"
#include "statistics/clusters.h"
#include "statistics/values.h"

namespace mimik::statistics {
namespace {

/// Calls far(signs) for every arrangement, the first cluster's sign held: its mirror image is as far from 0.
template <class Far>
std::size_t count_all(std::size_t clusters, const Far& far) {
    std::size_t found = 0;
    std::vector<double> signs(clusters, 1.0);
    for (std::uint64_t arrangement = 0; arrangement < std::uint64_t{1} << (clusters - 1); ++arrangement) {
        for (std::size_t c = 1; c < clusters; ++c) signs[c] = (arrangement >> (c - 1)) & 1 ? -1.0 : 1.0;
        found += far(signs) ? 2 : 0;
    }
    return found;
}

template <class Far>
std::size_t count_drawn(std::size_t clusters, const SignFlipOptions& options, const Far& far) {
    std::vector<char> is_far(static_cast<std::size_t>(options.resamples));
    base::parallel_for(is_far.size(), 200, [&](std::size_t begin, std::size_t end) {
        std::vector<double> signs(clusters);
        for (std::size_t k = begin; k < end; ++k) {
            base::RandomStream chance(options.seed, "sign-flip/" + std::to_string(k));
            for (double& sign : signs) sign = chance.uniform() < 0.5 ? -1.0 : 1.0;
            is_far[k] = far(signs);
        }
    });
    return static_cast<std::size_t>(std::count(is_far.begin(), is_far.end(), 1));
}

}  // namespace

void SignFlipOptions::check() const {
    if (resamples < 100) throw InputError(fmt::format("resamples is {}; give 100 or more, such as 10000", resamples));
    if (exact_up_to < 0 || exact_up_to > 24)
        throw InputError(
            fmt::format("exact_up_to is {}; give 0 to 24: 24 clusters have 16,777,216 arrangements", exact_up_to));
}

SignFlip sign_flip_test(std::span<const double> differences, std::span<const std::uint32_t> cluster,
                        const SignFlipOptions& options) {
    options.check();
    need_values(differences, 1, "a sign-flip test");
    if (differences.size() != cluster.size())
        throw InputError(fmt::format("a sign-flip test of {} differences and {} clusters; give one cluster for each",
                                     differences.size(), cluster.size()));
    const auto ids = dense_ids(cluster);
    std::vector<double> sums(ids.count, 0.0);
    for (std::size_t k = 0; k < differences.size(); ++k) sums[ids.of_case[k]] += differences[k];
    double observed = 0, longest = 0;
    for (const double sum : sums) observed += sum;
    for (const double difference : differences) longest += std::abs(difference);
    // Sums of other signs are rounded otherwise: by less than this.
    const double as_far = std::abs(observed) - 1e-12 * longest;
    const auto far = [&](const std::vector<double>& signs) {
        double sum = 0;
        for (std::size_t c = 0; c < sums.size(); ++c) sum += signs[c] * sums[c];
        return std::abs(sum) >= as_far;
    };
    SignFlip result;
    result.mean = mean_of(differences);
    result.clusters = ids.count;
    result.exact = ids.count <= static_cast<std::size_t>(options.exact_up_to);
    if (result.exact) {
        result.arrangements = std::size_t{1} << ids.count;
        result.p = static_cast<double>(count_all(ids.count, far)) / static_cast<double>(result.arrangements);
    } else {
        result.arrangements = static_cast<std::size_t>(options.resamples);
        result.p = static_cast<double>(count_drawn(ids.count, options, far) + 1) /
                   static_cast<double>(result.arrangements + 1);
    }
    return result;
}

}  // namespace mimik::statistics
