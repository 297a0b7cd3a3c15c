#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "evaluation/comparison.h"
#include "facs/facs_catalogue.h"

namespace mimik::report {

/// What the page of an experiment is made of beside its rows. Nothing in it depends on a machine or the time.
struct PageExperiment {
    std::string title;                         ///< "thesis": the name of the experiment's file
    std::string scores;                        ///< content of scores.json
    std::string identity;                      ///< content of experiment.json
    evaluation::ComparisonOptions comparison;  ///< of the intervals, as statistics/methods.csv has them
    std::vector<std::string> remarks = {};     ///< what is not on the page, and why
    std::size_t most_cases = 20'000;           ///< rows of the table of faces; of more the worst and the best ones
};

/// Everything that the page shows but faces, as one JSON value (docs/report.md): methods, intervals, differences,
/// anchors, and the error of every target, expression and method. A pure function of the rows and of what `experiment`
/// says. @param catalogue  names AUs in words. @throws InputError as compare_methods, or if a text is no JSON of ours.
[[nodiscard]] std::string page_data(const evaluation::CaseRowReader& read, const PageExperiment& experiment,
                                    const facs::FacsCatalogue& catalogue);

/// What is installed with the program: template, style and the bundled script.
struct PageParts {
    std::string page, style, script;
};
/// @throws InputError naming the file that is missing.
[[nodiscard]] PageParts read_page_parts(const std::filesystem::path& folder);

/// One HTML file that needs nothing else. Text is escaped wherever it came from, also inside the embedded JSON.
/// @param data   of page_data()
/// @param faces  of page_faces(); empty: no faces
/// @throws InputError if the template is none.
[[nodiscard]] std::string experiment_page(const PageParts& parts, const PageExperiment& experiment,
                                          const std::string& data, const std::string& faces);

/// JSON as it may stand between <script> tags: no '<', no '&', no line separator of JavaScript, the same value.
[[nodiscard]] std::string json_for_script(const std::string& json);

}  // namespace mimik::report
