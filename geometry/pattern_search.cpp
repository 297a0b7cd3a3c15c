#include "geometry/pattern_search.h"

#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::geometry {

void PatternSearchOptions::check() const {
    if (!(std::isfinite(first_step) && first_step > 0))
        throw InputError(fmt::format("first_step is {}; give more than 0", first_step));
    if (!(last_step > 0 && last_step <= first_step))
        throw InputError(
            fmt::format("last_step is {}; give more than 0 and at most first_step, {}", last_step, first_step));
    if (!(shrink > 0 && shrink < 1)) throw InputError(fmt::format("shrink is {}; give between 0 and 1", shrink));
    if (most_evaluations < 1) throw InputError(fmt::format("most_evaluations is {}; give 1 or more", most_evaluations));
}

namespace {

/// A rounding error is no progress: without a least one the search could go on for ever.
constexpr double least_gain = 1e-12;

class Search {
public:
    Search(std::vector<double> start, const std::function<double(std::span<const double>)>& function,
           const std::function<void(std::span<double>)>& project, const PatternSearchOptions& options,
           const std::function<void(int, double)>& done)
        : function_(function), project_(project), options_(options), done_(done) {
        if (project_) project_(start);
        result_.best = std::move(start);
        result_.value = value_of(result_.best);
        if (!std::isfinite(result_.value))
            throw NumericalError(fmt::format("the function to be searched is {} at the start", result_.value));
    }

    PatternSearchResult run() {
        for (double step = options_.first_step; step >= options_.last_step * (1 - 1e-9) && !spent();) {
            const auto base = result_.best;
            if (!round(step)) {
                step *= options_.shrink;
                continue;
            }
            repeat_what_helped(base);
        }
        result_.converged = !spent();
        return result_;
    }

private:
    [[nodiscard]] bool spent() const { return result_.evaluations >= options_.most_evaluations; }

    double value_of(std::span<const double> at) {
        ++result_.evaluations;
        const double value = function_(at);
        if (done_) done_(result_.evaluations, std::isfinite(result_.value) ? std::min(result_.value, value) : value);
        return value;
    }

    bool take_if_better(std::vector<double> trial) {
        if (spent()) return false;
        if (project_) project_(trial);
        if (trial == result_.best) return false;
        const double value = value_of(trial);
        if (!(value < result_.value - least_gain)) return false;
        result_.best = std::move(trial);
        result_.value = value;
        return true;
    }

    /// One step up or down on every variable. @return whether any helped
    bool round(double step) {
        bool helped = false;
        for (std::size_t k = 0; k < result_.best.size(); ++k)
            for (const double way : {step, -step}) {
                auto trial = result_.best;
                trial[k] += way;
                if (!take_if_better(std::move(trial))) continue;
                helped = true;
                break;
            }
        return helped;
    }

    void repeat_what_helped(const std::vector<double>& base) {
        auto trial = result_.best;
        for (std::size_t k = 0; k < trial.size(); ++k) trial[k] += result_.best[k] - base[k];
        (void)take_if_better(std::move(trial));
    }

    const std::function<double(std::span<const double>)>& function_;
    const std::function<void(std::span<double>)>& project_;
    const PatternSearchOptions& options_;
    const std::function<void(int, double)>& done_;
    PatternSearchResult result_;
};

}  // namespace

PatternSearchResult pattern_search(std::vector<double> start,
                                   const std::function<double(std::span<const double>)>& function,
                                   const std::function<void(std::span<double>)>& project,
                                   const PatternSearchOptions& options, const std::function<void(int, double)>& done) {
    options.check();
    return Search(std::move(start), function, project, options, done).run();
}

}  // namespace mimik::geometry
