#pragma once

#include <string>

#include "evaluation/experiment.h"

namespace mimik::report {

/// The report as people read it: one line per method with the explained fraction per expression, the mean, the median
/// case, the share of the true field of the same kind, the whole face and the share of cases worse than doing nothing;
/// then doing nothing and every error in millimetres. Markdown.
[[nodiscard]] std::string to_markdown(const evaluation::ExperimentReport& report);

/// One row per method and expression, every figure of Score; header line; classic locale.
[[nodiscard]] std::string to_csv(const evaluation::ExperimentReport& report);

/// Schema 1.
[[nodiscard]] std::string to_json(const evaluation::ExperimentReport& report);

}  // namespace mimik::report
