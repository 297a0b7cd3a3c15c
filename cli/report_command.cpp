#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/folder_lock.h"
#include "cli/command.h"
#include "cli/experiment_folder.h"
#include "cli/notes.h"
#include "cli/report_page.h"
#include "evaluation/experiment_file.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    Common common;
    std::string folder, file, workspace;
    report::PageFacesOptions faces;
    bool no_workspace = false;
};

/// Where the run said that its file and its workspace are; empty: it did not say.
std::string recorded(const ExperimentFolder& folder, const char* field) {
    if (!base::is_there(folder.provenance())) return {};
    return io::parse_json(base::read_text(folder.provenance(), io::most_json_bytes), folder.provenance().string())
        .value(field, std::string());
}

int run(const Arguments& arguments) {
    const ExperimentFolder folder(arguments.folder);
    if (!folder.whole())
        throw InputError(fmt::format("{}: is no finished experiment (no manifest.json); finish it with 'mimik run'",
                                     folder.root().string()));
    if (const auto missing = why_no_page(); !missing.empty()) throw InputError(missing);
    const base::FolderLock lock(folder.root(), base::FolderLock::Use::write);
    const auto name = arguments.file.empty() ? recorded(folder, "experiment") : arguments.file;
    const auto title = name.empty() ? std::string("experiment") : fs::path(name).stem().string();
    std::vector<std::string> remarks;
    if (arguments.no_workspace || name.empty()) {
        remarks = write_page(folder, title, facs::builtin_catalogue(), nullptr, nullptr, arguments.faces);
    } else {
        const auto place = arguments.workspace.empty() ? recorded(folder, "workspace") : arguments.workspace;
        const auto file = evaluation::read_experiment_file(name);
        const auto catalogue = catalogue_of(file);
        const preprocessing::Workspace workspace(place);
        const evaluation::PerformanceReader reader(workspace);
        const auto experiment = planned(file, reader, catalogue);
        folder.require(experiment.identity);
        remarks = write_page(folder, title, catalogue, &reader, &experiment.plan, arguments.faces);
    }
    const auto bytes = fs::file_size(folder.page());
    if (arguments.common.json)
        std::cout << io::json_text(
            nlohmann::json{{"schema", 1}, {"page", folder.page().string()}, {"bytes", bytes}, {"remarks", remarks}});
    else
        std::cout << fmt::format("{}: {:.1f} MB\n", folder.page().string(), static_cast<double>(bytes) / 1e6);
    if (!arguments.common.quiet && !arguments.common.json) say_notes(remarks);
    return exit_done;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand(
        "report", "Write the page of a finished experiment: tables, plots and faces in one HTML file");
    auto arguments = std::make_shared<Arguments>();
    auto& faces = arguments->faces;
    command->add_option("OUT", arguments->folder, "Folder made by 'mimik run'")->required();
    command
        ->add_option("--faces", faces.most_faces, "How many faces it holds, from the best target to the worst; 0: none")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);
    command->add_option("--target", faces.targets, "Hold the faces of these subjects instead: repeat, or bs003,bs007")
        ->delimiter(',');
    command
        ->add_option("--method", faces.methods,
                     "Show the motion of these methods instead of the first and the best ones: repeat, or default,mean")
        ->delimiter(',');
    command->add_option("--file", arguments->file, "The experiment's file, where it was moved");
    command->add_option("--workspace", arguments->workspace, "The experiment's workspace, where it was moved");
    command->add_flag("--no-workspace", arguments->no_workspace, "Make a page without faces from the results alone");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
