#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/case_row.h"

namespace mimik::evaluation {

/// How well one estimator's error follows the true one over the cases of one expression and one method: over pairs of
/// subjects, never over several expressions or methods, whose different sizes alone would make any estimator look good.
struct EstimatorAgreement {
    std::string expression, method, estimator, region, metric;
    std::size_t n = 0;                                 ///< cases
    std::optional<double> pearson, spearman, kendall;  ///< with the true error; empty: fewer than 3 cases, or constant
    double estimate = 0, true_mm = 0;                  ///< means over the cases
};

/// One estimator and one method over all their expressions.
struct EstimatorSummary {
    std::string method, estimator, region;
    std::size_t expressions = 0, cases = 0;
    std::optional<double> least_pearson, median_pearson, least_spearman, median_spearman, least_kendall;
    std::string worst;  ///< the expression with the least Pearson
};

struct EstimatorCheck {
    std::vector<EstimatorAgreement> agreements;  ///< by estimator and region, then method, then expression
    std::vector<EstimatorSummary> summaries;     ///< by estimator and region, then method
};

/// A pure function of rows (case_store.h): the true error is `true_distance, zone, mean`; what is compared with it is
/// `surface_distance` and every estimator of the pipeline, by the metric that stands for it, in the zone. Doing
/// nothing, true fields, and cases that are scored as doing nothing take no part: they are no method's errors.
/// @throws InputError if no row has a true error: the database has no truth.
[[nodiscard]] EstimatorCheck check_estimators(
    const std::function<void(const std::function<void(const CaseRow&)>&)>& read);

}  // namespace mimik::evaluation
