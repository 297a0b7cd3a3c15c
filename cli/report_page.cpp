#include "cli/report_page.h"

#include <cstdlib>
#include <exception>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "cli/notes.h"
#include "io/json_values.h"
#include "report/experiment_page.h"
#include "report/rows_files.h"

namespace mimik::cli {
namespace fs = std::filesystem;

fs::path page_parts_folder() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing here sets variables
    if (const char* named = std::getenv("MIMIK_PAGE"); named && *named != '\0') return named;
    std::error_code ignored;
    return fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() / "share" / "mimik" / "report";
}

std::string why_no_page() {
    const auto script = page_parts_folder() / "page.js";
    if (base::is_there(script)) return {};
    return fmt::format(
        "report.html: not made, since {} is not there; install npm, configure and build again, then give 'mimik report "
        "OUT'",
        script.string());
}

std::vector<std::string> write_page(const ExperimentFolder& folder, const std::string& title,
                                    const facs::FacsCatalogue& catalogue, const evaluation::PerformanceReader* reader,
                                    const evaluation::ExperimentPlan* plan, const report::PageFacesOptions& options) {
    const auto read = [&](const auto& visit) { report::read_rows_csv(folder.rows(), visit); };
    const auto parts = report::read_page_parts(page_parts_folder());
    report::PageExperiment experiment;
    experiment.title = title;
    experiment.scores = base::read_text(folder.root() / "scores.json", io::most_json_bytes);
    experiment.identity = base::read_text(folder.identity(), io::most_json_bytes);
    const auto identity = io::parse_json(experiment.identity, folder.identity().string());
    try {
        io::read_field(identity, "experiment", [&](const nlohmann::json& run) {
            experiment.comparison.seed = io::read_field<std::uint64_t>(run, "seed");
            experiment.comparison.resamples = io::read_field<int>(run, "resamples");
            experiment.comparison.confidence = io::read_field<double>(run, "confidence");
            return 0;
        });
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", folder.identity().string(), e.what()));
    }
    std::string faces;
    if (reader && plan && (options.most_faces > 0 || !options.targets.empty()))
        faces = report::page_faces(*reader, catalogue, *plan, report::choose_faces(read, *plan, options), options,
                                   experiment.remarks);
    const auto data = report::page_data(read, experiment, catalogue);
    base::write_atomically(folder.page(), report::experiment_page(parts, experiment, data, faces));
    return experiment.remarks;
}

std::string make_page(const Common& common, const ExperimentFolder& folder, const fs::path& file,
                      const facs::FacsCatalogue& catalogue, const evaluation::PerformanceReader& reader,
                      const evaluation::ExperimentPlan& plan) {
    if (const auto missing = why_no_page(); !missing.empty()) {
        if (!common.quiet) say_notes({missing});
        return {};
    }
    try {
        const auto remarks = write_page(folder, file.stem().string(), catalogue, &reader, &plan, {});
        if (!common.quiet && !common.json) say_notes(remarks);
    } catch (const std::exception& e) {
        return fmt::format("{}: not made: {}", folder.page().string(), e.what());
    }
    return {};
}

}  // namespace mimik::cli
