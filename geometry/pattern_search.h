#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "base/fields.h"

namespace mimik::geometry {

/// Lengths are in the unit of the variables.
struct PatternSearchOptions {
    double first_step = 4.0;
    double last_step = 0.5;  ///< it ends when a step this long finds nothing better on any variable
    double shrink = 0.5;     ///< of the step, when it finds nothing
    int most_evaluations = 4000;

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("first_step", self.first_step);
        visit("last_step", self.last_step);
        visit("shrink", self.shrink);
        visit("most_evaluations", self.most_evaluations);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<PatternSearchOptions>());

struct PatternSearchResult {
    std::vector<double> best;
    double value = 0;
    int evaluations = 0;
    bool converged = false;  ///< it ended by the last step, not by the number of evaluations
};

/// Lowest value of a function without derivatives: tries a step up and down on one variable after another, keeps what
/// is lower, repeats a round that helped (pattern move), and halves the step where no round helps. Deterministic.
/// Source: Hooke and Jeeves, "Direct search" solution of numerical and statistical problems, J. ACM 8(2), 1961.
/// @param function  infinite where there is no answer; finite at the start
/// @param project   brings variables back to where they may be; empty: anywhere
/// @param done      told after each evaluation; empty: nobody
/// @throws InputError for bad options, NumericalError if the function is not finite at the start.
[[nodiscard]] PatternSearchResult pattern_search(std::vector<double> start,
                                                 const std::function<double(std::span<const double>)>& function,
                                                 const std::function<void(std::span<double>)>& project = {},
                                                 const PatternSearchOptions& options = {},
                                                 const std::function<void(int, double)>& done = {});

}  // namespace mimik::geometry
