#pragma once

#include <string>

#include "evaluation/estimator_check.h"

namespace mimik::report {

/// Every estimator, metric, region and alignment with its definition. Markdown.
[[nodiscard]] std::string estimators_markdown();
/// The same as one document, schema 1.
[[nodiscard]] std::string estimators_json();

/// How well estimators follow the true error: a summary, then one line per estimator, method and expression. Markdown.
[[nodiscard]] std::string to_markdown(const evaluation::EstimatorCheck& check);
/// One row per estimator, method and expression; header line; classic locale.
[[nodiscard]] std::string to_csv(const evaluation::EstimatorCheck& check);

}  // namespace mimik::report
