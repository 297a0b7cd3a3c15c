#include <chrono>
#include <filesystem>
#include <iostream>
#include <string>
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
#include "cli/run_steps.h"
#include "cli/shard_files.h"
#include "evaluation/cast.h"
#include "evaluation/experiment.h"
#include "evaluation/shard.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;

/// "db" and "db/" are one.
fs::path full_path(const fs::path& folder) {
    const auto path = fs::absolute(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
}

/// @throws InputError if the folder's workspace was made of another database than the one that a shard is to use.
void require_same_database(const ExperimentFolder& folder, const evaluation::ExperimentFile& file) {
    const auto mark = folder.preprocessing_mark();
    const auto document = io::parse_json(base::read_text(mark, io::most_json_bytes), mark.string());
    const auto found = document.find("database");
    const fs::path there = found != document.end() && found->is_string() ? found->get<std::string>() : "";
    const auto own = full_path(file.database);
    std::error_code none;
    if (there == own || fs::equivalent(there, own, none)) return;
    throw InputError(
        fmt::format("{}: scans of {} were preprocessed, not of {}; give another folder with -o, or that "
                    "database",
                    mark.string(), there.empty() ? "another database" : there.string(), own.string()));
}

/// Reads every performance and studies it once: what is registered on the way is kept in the workspace, so that no two
/// shards do it again.
void study_all(const RunArguments& arguments, const evaluation::PerformanceReader& reader,
               const facs::FacsCatalogue& catalogue, const evaluation::ExperimentPlan& plan) {
    Progress progress(arguments.common, "prepare", plan.expressions.size());
    for (const auto& planned : plan.expressions) {
        evaluation::FailureList said_by_the_shards;
        const animation::LearningTask task{planned.expression, reader.workspace().average(), catalogue,
                                           reader.workspace().registrations()};
        (void)evaluation::gather_cast(reader, task, planned.performances, plan.methods, said_by_the_shards, plan.zones);
        progress.advance(planned.expression.code());
    }
}

/// "7 units, 3 of an earlier attempt"
int say_shard(const RunArguments& arguments, const ShardFiles& files, std::size_t units, std::size_t found,
              double seconds) {
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::ordered_json{{"schema", 1},
                                                          {"shard", files.shard().text()},
                                                          {"units", units},
                                                          {"of_earlier_attempts", found},
                                                          {"seconds", seconds},
                                                          {"rows", files.rows().string()}});
    else
        std::cout << fmt::format("shard {}: {}{} in {:.1f} s, {}\n", files.shard().text(), base::counted(units, "unit"),
                                 found > 0 ? fmt::format(" ({} of an earlier attempt)", found) : "", seconds,
                                 files.rows().string());
    return exit_done;
}

/// What the merge looks up: where the experiment's file and its faces are.
void write_shard_provenance(const RunArguments& arguments, const evaluation::ExperimentFile& file,
                            const ShardFiles& files, std::size_t units, double seconds) {
    auto document =
        nlohmann::ordered_json::parse(provenance(arguments, file, file.workspace, seconds));  // "": OUT's own
    document["shard"] = files.shard().text();
    document["units_of_this_run"] = units;
    base::write_atomically(files.provenance(), io::json_text(document));
}

}  // namespace

int run_only_preprocess(const RunArguments& arguments) {
    const auto file = experiment_of(arguments);
    const ExperimentFolder folder(arguments.output);
    const auto catalogue = catalogue_of(file);
    const auto place = workspace_of(file, folder);
    check_output_folder(folder.root(), false);
    const base::FolderLock lock(folder.root(), base::FolderLock::Use::write);
    std::vector<std::string> unusable;
    if (file.workspace.empty()) unusable = preprocess(arguments, file, catalogue, place);
    const preprocessing::Workspace workspace(place);
    const evaluation::PerformanceReader reader(workspace);
    const auto experiment = planned(file, reader, catalogue);
    study_all(arguments, reader, catalogue, experiment.plan);
    digests_of_faces(workspace, experiment.plan).write(folder.face_digests());
    const auto units = experiment.plan.units();
    const nlohmann::ordered_json document = {
        {"schema", 1},
        {"database", file.workspace.empty() ? full_path(file.database).string() : ""},
        {"expressions", file.expressions},
        {"failures", unusable},
        {"units", units}};
    base::write_atomically(folder.preprocessing_mark(), io::json_text(document));
    if (arguments.common.json)
        std::cout << io::json_text(document);
    else
        std::cout << fmt::format("{}: ready for {}{}\n", folder.root().string(), base::counted(units, "unit"),
                                 unusable.empty() ? "" : fmt::format("; left out:\n{}", fmt::join(unusable, "\n")));
    return unusable.empty() ? exit_done : exit_done_with_failures;
}

std::vector<std::string> unusable_of_preprocessing(const ExperimentFolder& folder,
                                                   const evaluation::ExperimentFile& file) {
    const auto mark = folder.preprocessing_mark();
    const auto mend = fmt::format("run 'mimik run {} -o {} --only-preprocess' once, before all shards", file.name,
                                  folder.root().string());
    if (!base::is_there(mark))
        throw InputError(fmt::format("{}: the scans are not preprocessed yet; {}", folder.root().string(), mend));
    const auto document = io::parse_json(base::read_text(mark, io::most_json_bytes), mark.string());
    try {
        if (io::read_field<std::vector<std::string>>(document, "expressions") != file.expressions)
            throw InputError(fmt::format("other expressions were preprocessed; {}", mend));
        return io::read_field<std::vector<std::string>>(document, "failures");
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", mark.string(), e.what()));
    }
}

int run_shard(const RunArguments& arguments) {
    const auto start = std::chrono::steady_clock::now();
    const auto shard = evaluation::parse_shard(arguments.shard);
    const auto file = experiment_of(arguments);
    const ExperimentFolder folder(arguments.output);
    const auto catalogue = catalogue_of(file);
    check_output_folder(folder.root(), false);
    if (file.workspace.empty()) {
        (void)unusable_of_preprocessing(folder, file);
        require_same_database(folder, file);
    }
    const preprocessing::Workspace workspace(workspace_of(file, folder));
    const evaluation::PerformanceReader reader(workspace);
    const auto experiment = planned(file, reader, catalogue, InputDigests::read(folder.face_digests()));
    folder.claim(experiment.identity);
    folder.require(experiment.identity);  // whoever claimed it at the same time
    ShardFiles files(folder.root(), shard, experiment.identity);
    const auto range = shard.of(experiment.plan.units());
    const auto units = range.end - range.begin;
    if (files.whole()) {
        files.check();
        if (!arguments.common.quiet) std::cerr << fmt::format("shard {}: was run already\n", shard.text());
        return say_shard(arguments, files, units, units, 0);
    }
    std::size_t found = 0;
    {
        auto store = files.begin(found);
        Progress progress(arguments.common, "shard " + shard.text(), units);
        evaluation::run_units(reader, catalogue, experiment.plan, range, store,
                              [&](const std::string& unit) { progress.advance(unit); });
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_shard_provenance(arguments, file, files, units - std::min(units, found), seconds);
    files.finish();
    return say_shard(arguments, files, units, found, seconds);
}

}  // namespace mimik::cli
