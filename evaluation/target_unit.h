#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "evaluation/case_row.h"
#include "evaluation/cast.h"
#include "evaluation/estimator.h"
#include "evaluation/plan.h"

namespace mimik::evaluation {

/// Sees what is judged, which is gone when it returns.
using CaseVisitor = std::function<void(const CaseKey&, const JudgedFace&)>;

/// The rows of one unit of work: target t of the cast with every method and source, in the order of the plan. Holds one
/// performance and what is prepared from it, whatever the number of sources. A method that gives no answer is scored as
/// doing nothing, its rows say why, and it is added to `failures`; what keeps the target itself from being scored is
/// added too, and it has no row: methods stay comparable.
/// @param visit  called with every case that has an answer; may be empty
[[nodiscard]] std::vector<CaseRow> score_target(const PerformanceReader& reader, const ExperimentPlan& plan,
                                                const Cast& cast, std::size_t t, FailureList& failures,
                                                const CaseVisitor& visit = {});

/// Calls work(t) for t = 0 ... count - 1, in parallel and begun in that order, and take(t, its rows) in exactly that
/// order, one at a time. What waits for an earlier one is what the other threads have finished meanwhile. After work or
/// take of a unit has thrown, no later unit is taken, and the exception of the first such unit is thrown.
void in_order(std::size_t count, const std::function<std::vector<CaseRow>(std::size_t)>& work,
              const std::function<void(std::size_t, const std::vector<CaseRow>&)>& take);

}  // namespace mimik::evaluation
