#pragma once

#include <string>

#include "evaluation/run_comparison.h"

namespace mimik::report {

/// Explained fraction and error of each method, run by run, and how sure the differences are. Markdown.
[[nodiscard]] std::string to_markdown(const evaluation::RunComparison& comparison,
                                      const evaluation::ComparisonOptions& options);

/// One row per region, expression, method and run; header line; classic locale. An empty expression means all.
[[nodiscard]] std::string run_comparison_csv(const evaluation::RunComparison& comparison);

}  // namespace mimik::report
