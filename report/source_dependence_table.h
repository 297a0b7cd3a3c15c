#pragma once

#include <string>

#include "evaluation/source_dependence.h"

namespace mimik::report {

/// A table per region: how much of the errors' variance is due to whose expression was taken. Markdown; empty where no
/// method learns from one source.
[[nodiscard]] std::string to_markdown(const evaluation::SourceDependences& dependences);

/// One row per region, expression and method; header line; classic locale.
[[nodiscard]] std::string source_dependence_csv(const evaluation::SourceDependences& dependences);

}  // namespace mimik::report
