#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/experiment_file.h"
#include "evaluation/performance.h"
#include "evaluation/plan.h"
#include "facs/facs_catalogue.h"

namespace mimik::cli {

/// @throws InputError naming line and key of the first case that the plan does not have.
void check_per_vertex(const evaluation::ExperimentFile& file, const evaluation::ExperimentPlan& plan);

/// Writes `per_vertex/TARGET_EXPRESSION_METHOD[_SOURCE].ply` (evaluation/per_vertex.h) of every case that the file asks
/// for, and `per_vertex/cases.csv`, which lists them; nothing where it asks for none. A case that has no answer has no
/// file. @return targets that take no part in their expression, each with the reason
/// @throws InputError if they cannot be written.
[[nodiscard]] std::vector<std::string> write_per_vertex(const std::filesystem::path& root,
                                                        const evaluation::ExperimentFile& file,
                                                        const evaluation::PerformanceReader& reader,
                                                        const facs::FacsCatalogue& catalogue,
                                                        const evaluation::ExperimentPlan& plan);

/// Those that were written, with their list.
[[nodiscard]] std::vector<std::filesystem::path> per_vertex_files(const std::filesystem::path& root);

}  // namespace mimik::cli
