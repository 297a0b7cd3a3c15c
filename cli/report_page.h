#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/experiment_folder.h"
#include "evaluation/case_row.h"
#include "evaluation/comparison.h"
#include "report/page_faces.h"

namespace mimik::cli {

/// Where template, style and script of the page lie: ../share/mimik/report beside the running program, or what the
/// variable MIMIK_PAGE says.
[[nodiscard]] std::filesystem::path page_parts_folder();

/// Why there can be no page, and how to get one; empty: the page's script is there.
[[nodiscard]] std::string why_no_page();

/// The rows of rows.csv, in its order. @throws InputError if it is no table of rows.
void read_rows_csv(const std::filesystem::path& file, const std::function<void(const evaluation::CaseRow&)>& visit);

/// Writes OUT/report.html of a finished experiment. @param planned  of its workspace; null: a page without faces
/// @return what is not on the page, and why. @throws InputError if a file of the folder is not as a run left it.
std::vector<std::string> write_page(const ExperimentFolder& folder, const std::string& title,
                                    const facs::FacsCatalogue& catalogue, const evaluation::PerformanceReader* reader,
                                    const evaluation::ExperimentPlan* plan, const report::PageFacesOptions& options);

}  // namespace mimik::cli
