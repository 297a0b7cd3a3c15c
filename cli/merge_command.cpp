#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/folder_lock.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/experiment_folder.h"
#include "cli/notes.h"
#include "cli/per_vertex_files.h"
#include "cli/report_page.h"
#include "cli/run_steps.h"
#include "cli/shard_files.h"
#include "evaluation/case_store.h"
#include "evaluation/experiment.h"
#include "evaluation/experiment_file.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    RunArguments run;  // output: the folder
    std::size_t shards = 0;
    bool list_missing = false;
};

std::vector<std::size_t> missing_shards(const ExperimentFolder& folder, std::size_t count) {
    std::vector<std::size_t> missing;
    for (std::size_t k = 1; k <= count; ++k)
        if (!ShardFiles(folder.root(), {k, count}, "").whole()) missing.push_back(k);
    return missing;
}

/// What the shards wrote of themselves, each that did.
std::vector<nlohmann::json> provenances(const ExperimentFolder& folder, std::size_t count) {
    std::vector<nlohmann::json> documents;
    for (std::size_t k = 1; k <= count; ++k) {
        const auto file = ShardFiles(folder.root(), {k, count}, "").provenance();
        if (base::is_there(file))
            documents.push_back(io::parse_json(base::read_text(file, io::most_json_bytes), file.string()));
    }
    return documents;
}

/// @throws InputError naming what is missing, and the command that makes it.
void require_all(const ExperimentFolder& folder, std::size_t count, const std::string& experiment) {
    const auto missing = missing_shards(folder, count);
    if (missing.empty()) return;
    throw InputError(fmt::format("{}: {} of {} missing: {}; make {} with 'mimik run {} -o {} --shard {}/{}'{}",
                                 folder.root().string(), base::counted(missing.size(), "shard"), count,
                                 number_list(missing), missing.size() > 1 ? "each" : "it",
                                 experiment.empty() ? "EXPERIMENT" : experiment, folder.root().string(),
                                 missing.front(), count, missing.size() > 1 ? " and so on" : ""));
}

/// Where the experiment's file and its faces are: as the command line says, else as the shards did.
void complete(RunArguments& run, const std::vector<nlohmann::json>& shards, const ExperimentFolder& folder) {
    for (const auto& [key, value] : {std::pair{"experiment", &run.file}, std::pair{"workspace", &run.workspace}}) {
        if (!value->empty()) continue;
        if (shards.empty())
            throw InputError(fmt::format("{}: no shard says where its experiment is; give --experiment and --workspace",
                                         folder.root().string()));
        *value = io::read_field<std::string>(shards.front(), key);
    }
}

std::string merged_provenance(const Arguments& arguments, const evaluation::ExperimentFile& file, const fs::path& place,
                              const std::vector<nlohmann::json>& shards, double seconds) {
    auto document = nlohmann::ordered_json::parse(provenance(arguments.run, file, place, seconds));
    double seconds_of_shards = 0;
    std::set<std::string> hosts;
    for (const auto& shard : shards) {
        seconds_of_shards += io::read_field<double>(shard, "seconds_of_this_run");
        hosts.insert(io::read_field<std::string>(shard, "host"));
    }
    document["shards"] = arguments.shards;
    document["seconds_of_shards"] = seconds_of_shards;  // of the last attempt of each
    document["hosts_of_shards"] = hosts;
    return io::json_text(document);
}

/// @return why there is no page; empty: there is one, or there can be none
std::string merge(const Arguments& arguments, const ExperimentFolder& folder) {
    const auto start = std::chrono::steady_clock::now();
    const auto& run = arguments.run;
    auto file = evaluation::read_experiment_file(run.file);
    file.workspace = run.workspace;  // empty: the folder's own
    const auto place = workspace_of(file, folder);
    const auto unusable = file.workspace.empty() ? unusable_of_preprocessing(folder, file) : std::vector<std::string>();
    const auto catalogue = catalogue_of(file);
    const preprocessing::Workspace workspace(place);
    const evaluation::PerformanceReader reader(workspace);
    const auto experiment = planned(file, reader, catalogue);
    folder.require(experiment.identity);
    std::vector<fs::path> files;
    for (std::size_t k = 1; k <= arguments.shards; ++k) {
        const ShardFiles shard(folder.root(), {k, arguments.shards}, experiment.identity);
        shard.check();
        files.push_back(shard.rows());
    }
    auto store = evaluation::CaseStore::of_files(std::move(files));
    auto report = evaluation::run_experiment(reader, catalogue, experiment.plan, store, {});
    report.failures.insert(report.failures.begin(), unusable.begin(), unusable.end());
    if (!run.common.quiet) say_notes(report.remarks);
    for (auto& failure : write_per_vertex(folder.root(), file, reader, catalogue, experiment.plan))
        report.failures.push_back(std::move(failure));
    write_results(folder, store, file, report);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    base::write_atomically(folder.provenance(),
                           merged_provenance(arguments, file, place, provenances(folder, arguments.shards), seconds));
    folder.seal();
    return make_page(run.common, folder, run.file, catalogue, reader, experiment.plan);
}

int run(Arguments arguments) {
    const ExperimentFolder folder(arguments.run.output);
    if (!base::is_there(folder.root()))
        throw InputError(
            fmt::format("{}: is not there; give the folder of 'mimik run --shard'", folder.root().string()));
    if (arguments.list_missing) {
        arguments.shards = shard_count(folder.root(), arguments.shards);
        const auto missing = missing_shards(folder, arguments.shards);
        if (arguments.run.common.json)
            std::cout << io::json_text(
                nlohmann::ordered_json{{"schema", 1}, {"shards", arguments.shards}, {"missing", missing}});
        else if (!missing.empty())
            std::cout << number_list(missing, ",") << "\n";
        return exit_done;
    }
    const base::FolderLock lock(folder.root(), base::FolderLock::Use::write);
    if (folder.whole()) {
        if (const auto damage = folder.damage(); !damage.empty())
            throw InputError(fmt::format("{}: {}; remove manifest.json and merge again", folder.root().string(),
                                         fmt::join(damage, "; ")));
        if (!arguments.run.common.quiet)
            std::cerr << fmt::format("{}: is whole already, nothing is left to do\n", folder.root().string());
        return say_result(arguments.run, folder);
    }
    arguments.shards = shard_count(folder.root(), arguments.shards);
    const auto shards = provenances(folder, arguments.shards);
    require_all(folder, arguments.shards,
                !arguments.run.file.empty() || shards.empty()
                    ? arguments.run.file
                    : io::read_field<std::string>(shards.front(), "experiment"));
    complete(arguments.run, shards, folder);
    const auto no_page = merge(arguments, folder);
    const int code = say_result(arguments.run, folder);
    if (no_page.empty()) return code;
    say_failures({no_page});
    return exit_done_with_failures;
}

}  // namespace

void add_merge_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("merge", "Make one experiment of the shards that 'mimik run --shard' left");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("OUT", arguments->run.output, "Folder of the shards, and of the results")->required();
    command->add_option("--shards", arguments->shards, "How many there are; otherwise as the folder says")
        ->check(CLI::Range(std::size_t{1}, evaluation::most_shards));
    command->add_flag("--list-missing", arguments->list_missing,
                      "Say which shards are still to be run, as sbatch --array takes them, and do nothing");
    command->add_option("--experiment", arguments->run.file, "The experiment file, where it lies elsewhere by now");
    command->add_option("--workspace", arguments->run.workspace, "The workspace, where it lies elsewhere by now");
    add_common_options(*command, arguments->run.common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
