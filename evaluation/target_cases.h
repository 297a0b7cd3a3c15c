#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "evaluation/case_score.h"
#include "evaluation/expression_cast.h"

namespace mimik::evaluation {

/// The cases of one target, in the order of their sources; a mean is one case.
struct TargetCases {
    std::vector<std::vector<CaseResult>> methods;  ///< per method
    std::vector<CaseResult> true_field, true_field_mean;
};

/// Which cases are scored, beside the cast.
struct CaseChoice {
    std::span<const Method> methods;
    bool true_fields = false;
    bool whole_face = true;
    std::size_t max_sources = 0;  ///< the next ones after the target; 0 = all
};

/// Scores target t of the cast with all its sources. Holds one performance and what is prepared from it, whatever the
/// number of sources. A method that gives no answer counts as doing nothing and is added to `failures`; what keeps the
/// target itself from being scored is added too, and it has no case in any row: rows stay comparable.
[[nodiscard]] TargetCases score_target(const PerformanceReader& reader, const ExpressionCast& cast, std::size_t t,
                                       const CaseChoice& choice, FailureList& failures);

/// Calls score(t) for t = 0 ... count - 1, in parallel and begun in that order, and take(its cases) in exactly that
/// order, one at a time. What waits for an earlier one is at most what the other threads have finished meanwhile.
void score_in_order(std::size_t count, const std::function<TargetCases(std::size_t)>& score,
                    const std::function<void(const TargetCases&)>& take);

}  // namespace mimik::evaluation
