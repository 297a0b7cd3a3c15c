#pragma once

#include <string>

#include "evaluation/comparison.h"

namespace mimik::report {

/// How sure the differences between methods are: per region a table of methods over all expressions with intervals, and
/// one of their differences, in the order of the methods. Markdown.
[[nodiscard]] std::string to_markdown(const evaluation::Comparison& comparison,
                                      const evaluation::ComparisonOptions& options);

/// One row per region, expression and method; header line; classic locale. An empty expression means all.
[[nodiscard]] std::string methods_csv(const evaluation::Comparison& comparison);
/// One row per region, expression and two methods; header line.
[[nodiscard]] std::string differences_csv(const evaluation::Comparison& comparison);

/// Explained fraction with its interval, methods as rows and expressions as columns, for the package booktabs: the best
/// method of a column is bold, a bound never. Of the first region.
[[nodiscard]] std::string intervals_latex(const evaluation::Comparison& comparison,
                                          const evaluation::ComparisonOptions& options);

}  // namespace mimik::report
