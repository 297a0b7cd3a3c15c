#pragma once

#include <string>

#include "evaluation/experiment.h"

namespace mimik::report {

/// Any text as LaTeX prints it: "\_", "\%", "\&" and the like.
[[nodiscard]] std::string latex_text(const std::string& text);

/// The explained fraction of every method on every expression, their mean and the share of the true field, as a tabular
/// for the package booktabs. Of each kind of source the best method's figure of a column is bold; bounds, which look at
/// the truth, are in italics below a rule. What is not known is a dash.
[[nodiscard]] std::string explained_latex(const evaluation::ExperimentReport& report);

/// The mean distance to the real scan in mm, likewise; doing nothing is the first row.
[[nodiscard]] std::string error_latex(const evaluation::ExperimentReport& report);

}  // namespace mimik::report
