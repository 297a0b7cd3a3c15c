#include "statistics/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/quantile.h"
#include "base/random_stream.h"
#include "statistics/distributions.h"
#include "statistics/values.h"

namespace mimik::statistics {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of a weighted list of cases; room for one thread.
class Weighing {
public:
    Weighing(const Clusters& clusters, const WeightedStatistic& statistic)
        : clusters_(clusters), statistic_(statistic), weights_(clusters.cases()) {
        for (const std::size_t members : clusters.draws()) counts_.emplace_back(members, 1.0);
    }
    /// How often each member of each draw was drawn.
    [[nodiscard]] std::vector<std::vector<double>>& counts() { return counts_; }
    [[nodiscard]] double value() {
        clusters_.weigh(counts_, weights_);
        if (std::all_of(weights_.begin(), weights_.end(), [](double w) { return w == 0; })) return unknown;
        return statistic_(weights_);
    }

private:
    const Clusters& clusters_;
    const WeightedStatistic& statistic_;
    std::vector<std::vector<double>> counts_;
    std::vector<double> weights_;
};

std::vector<double> resample(const Clusters& clusters, const WeightedStatistic& statistic,
                             const BootstrapOptions& options) {
    std::vector<double> values(static_cast<std::size_t>(options.resamples));
    base::parallel_for(values.size(), 50, [&](std::size_t begin, std::size_t end) {
        Weighing weighing(clusters, statistic);
        for (std::size_t k = begin; k < end; ++k) {
            base::RandomStream chance(options.seed, "bootstrap/" + std::to_string(k));
            for (auto& counts : weighing.counts()) {
                std::fill(counts.begin(), counts.end(), 0.0);
                const auto members = static_cast<double>(counts.size());
                for (std::size_t drawn = 0; drawn < counts.size(); ++drawn)
                    counts[static_cast<std::size_t>(chance.uniform() * members)] += 1;
            }
            values[k] = weighing.value();
        }
    });
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    return values;
}

/// How the spread changes with the value, from what the statistic is without each subject.
double acceleration_of(const Clusters& clusters, const WeightedStatistic& statistic) {
    Weighing weighing(clusters, statistic);
    double cubes = 0, squares = 0;
    for (auto& counts : weighing.counts()) {
        std::vector<double> without;
        for (double& count : counts) {
            count = 0;
            const double value = weighing.value();
            if (std::isfinite(value)) without.push_back(value);
            count = 1;
        }
        if (without.size() < 2 || !differ(without)) continue;
        const double mean = mean_of(without);
        const auto n = static_cast<double>(without.size());
        for (const double value : without) {
            const double influence = (n - 1) / n * (mean - value);
            squares += influence * influence;
            cubes += influence * influence * influence;
        }
    }
    return squares > 0 ? cubes / (6 * squares * std::sqrt(squares)) : 0.0;
}

double bias_correction_of(const std::vector<double>& values, double estimate) {
    double below = 0;
    for (const double value : values) below += value < estimate ? 1.0 : value == estimate ? 0.5 : 0.0;
    const auto n = static_cast<double>(values.size());
    return normal_quantile(std::clamp(below, 0.5, n - 0.5) / n);
}

}  // namespace

void BootstrapOptions::check() const {
    check_confidence(confidence);
    if (resamples < 20) throw InputError(fmt::format("resamples is {}; give 20 or more, such as 2000", resamples));
}

WeightedStatistic weighted_mean(std::span<const double> values) {
    return [values](std::span<const double> weights) {
        double sum = 0, weight = 0;
        for (std::size_t k = 0; k < values.size(); ++k) {
            sum += weights[k] * values[k];
            weight += weights[k];
        }
        return sum / weight;
    };
}

WeightedStatistic weighted_ratio(std::span<const double> above, std::span<const double> below) {
    return [above, below](std::span<const double> weights) {
        double upper = 0, lower = 0;
        for (std::size_t k = 0; k < above.size(); ++k) {
            upper += weights[k] * above[k];
            lower += weights[k] * below[k];
        }
        return lower != 0 ? upper / lower : unknown;
    };
}

BootstrapInterval bootstrap_interval(const Clusters& clusters, const WeightedStatistic& statistic,
                                     const BootstrapOptions& options) {
    options.check();
    for (const std::size_t members : clusters.draws())
        if (members < 2) throw InputError(fmt::format("a bootstrap of {} subjects; give 2 or more", members));
    BootstrapInterval result;
    result.estimate = Weighing(clusters, statistic).value();
    if (!std::isfinite(result.estimate)) throw NumericalError("a bootstrap of a statistic that is not finite");
    const auto values = resample(clusters, statistic, options);
    result.resamples = values.size();
    if (2 * values.size() < static_cast<std::size_t>(options.resamples))
        throw NumericalError(fmt::format("a bootstrap of too few subjects: {} of {} resamples have no value",
                                         static_cast<std::size_t>(options.resamples) - values.size(),
                                         options.resamples));
    result.standard_error = std::sqrt(squares_about(values, mean_of(values)) / static_cast<double>(values.size() - 1));
    double low = 0.5 - 0.5 * options.confidence, high = 0.5 + 0.5 * options.confidence;
    if (options.kind == IntervalKind::bca) {
        result.bias_correction = bias_correction_of(values, result.estimate);
        result.acceleration = acceleration_of(clusters, statistic);
        const auto corrected = [&](double share) {
            const double z = result.bias_correction + normal_quantile(share);
            return normal_below(result.bias_correction + z / (1 - result.acceleration * z));
        };
        low = corrected(low);
        high = corrected(high);
    }
    result.interval = {base::quantile(values, low), base::quantile(values, high)};
    return result;
}

}  // namespace mimik::statistics
