#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/experiment_folder.h"
#include "evaluation/comparison.h"
#include "report/page_faces.h"

namespace mimik::cli {

/// Where template, style and script of the page lie: ../share/mimik/report beside the running program, or what the
/// variable MIMIK_PAGE says.
[[nodiscard]] std::filesystem::path page_parts_folder();

/// Why there can be no page, and how to get one; empty: the page's script is there.
[[nodiscard]] std::string why_no_page();

/// Writes OUT/report.html of a finished experiment. @param planned  of its workspace; null: a page without faces
/// @return what is not on the page, and why. @throws InputError if a file of the folder is not as a run left it.
std::vector<std::string> write_page(const ExperimentFolder& folder, const std::string& title,
                                    const facs::FacsCatalogue& catalogue, const evaluation::PerformanceReader* reader,
                                    const evaluation::ExperimentPlan* plan, const report::PageFacesOptions& options);

/// The page at the end of a run or a merge, where it can be made. What keeps it from being made spoils no result.
/// @param file  the experiment's, which names the page
/// @return the fault; empty: none
[[nodiscard]] std::string make_page(const Common& common, const ExperimentFolder& folder,
                                    const std::filesystem::path& file, const facs::FacsCatalogue& catalogue,
                                    const evaluation::PerformanceReader& reader,
                                    const evaluation::ExperimentPlan& plan);

}  // namespace mimik::cli
