#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/folder_lock.h"
#include "base/random_stream.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/experiment_folder.h"
#include "evaluation/case_store.h"
#include "evaluation/experiment.h"
#include "evaluation/experiment_file.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string folder, file, workspace, database;
    int units = 3;
    std::uint64_t seed = 1;
};

struct Sampled {
    std::size_t expression = 0;  // place in the plan
    std::string target;
};

/// Different units by chance, in the order of the plan.
std::vector<Sampled> sample(const evaluation::ExperimentPlan& plan, int count, std::uint64_t seed) {
    std::vector<Sampled> all;
    for (std::size_t e = 0; e < plan.expressions.size(); ++e)
        for (const auto& id : plan.expressions[e].performances)
            if (plan.is_target(id.subject)) all.push_back({e, id.subject});
    base::RandomStream random(seed, "verify");
    std::vector<Sampled> chosen;
    // Selection sampling: each unit is taken with the chance that is left to it (Knuth, TAOCP 3.4.2, algorithm S).
    auto wanted = std::min(all.size(), static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < all.size() && wanted > 0; ++k)
        if (random.uniform() * static_cast<double>(all.size() - k) < static_cast<double>(wanted)) {
            chosen.push_back(all[k]);
            --wanted;
        }
    return chosen;
}

using UnitKey = std::pair<std::string, std::string>;  // code of the expression, target

/// The rows of the units as rows.csv has them; the file is read once.
std::map<UnitKey, std::vector<std::string>> stored_rows(const std::filesystem::path& file,
                                                        const std::set<UnitKey>& units) {
    std::ifstream in(file, std::ios::binary);
    std::map<UnitKey, std::vector<std::string>> rows;
    std::string line;
    if (!std::getline(in, line) || line != evaluation::case_row_header())
        throw InputError(fmt::format("{}: is no table of rows; run the experiment again", file.string()));
    while (std::getline(in, line)) {
        const auto row = evaluation::decode_case_row(line);
        if (!row) throw InputError(fmt::format("{}: {} is no row", file.string(), base::in_quotes(line)));
        if (const UnitKey key{row->key.expression, row->key.target}; units.contains(key)) rows[key].push_back(line);
    }
    return rows;
}

std::vector<std::string> computed_rows(const evaluation::PerformanceReader& reader,
                                       const facs::FacsCatalogue& catalogue, evaluation::ExperimentPlan plan,
                                       const Sampled& unit) {
    plan.expressions = {plan.expressions[unit.expression]};
    plan.targets = {unit.target};
    evaluation::CaseStore store;
    try {
        (void)evaluation::run_experiment(reader, catalogue, plan, store);
    } catch (const InputError&) {  // a target that cannot be scored has no rows, and that is what is compared
    }
    std::vector<std::string> rows;
    store.read([&](const evaluation::CaseRow& row) {
        if (row.estimator != evaluation::run_estimator) rows.push_back(evaluation::encode_case_row(row));
    });
    return rows;
}

/// "bs003 12: row 5 is '...' there and '...' here"; empty: they are the same.
std::string compare(const std::vector<std::string>& there, const std::vector<std::string>& here) {
    if (there.size() != here.size()) return fmt::format("{} rows there, {} here", there.size(), here.size());
    for (std::size_t k = 0; k < there.size(); ++k)
        if (there[k] != here[k]) return fmt::format("'{}' there, '{}' here", there[k], here[k]);
    return {};
}

int run(const Arguments& arguments) {
    const ExperimentFolder folder(arguments.folder);
    if (!folder.whole())
        throw InputError(fmt::format("{}: is no finished experiment (no manifest.json); finish it with 'mimik run'",
                                     folder.root().string()));
    const base::FolderLock lock(folder.root(), base::FolderLock::Use::read);
    const auto recorded =
        io::parse_json(base::read_text(folder.provenance(), io::most_json_bytes), folder.provenance().string());
    const auto experiment_file =
        arguments.file.empty() ? io::read_field<std::string>(recorded, "experiment") : arguments.file;
    const auto place =
        arguments.workspace.empty() ? io::read_field<std::string>(recorded, "workspace") : arguments.workspace;
    auto differences = folder.damage();
    const auto file = evaluation::read_experiment_file(experiment_file);
    const auto catalogue = catalogue_of(file);
    const preprocessing::Workspace workspace(place);
    const evaluation::PerformanceReader reader(workspace);
    const auto experiment = planned(file, reader, catalogue);
    folder.require(experiment.identity);
    const auto units = sample(experiment.plan, arguments.units, arguments.seed);
    std::set<UnitKey> keys;
    for (const auto& unit : units)
        keys.insert({experiment.plan.expressions[unit.expression].expression.code(), unit.target});
    auto stored = stored_rows(folder.rows(), keys);
    std::size_t rows = 0;
    {
        Progress progress(arguments.common, "verify", units.size());
        for (const auto& unit : units) {
            const auto& code = experiment.plan.expressions[unit.expression].expression.code();
            const auto& there = stored[{code, unit.target}];
            const auto difference = compare(there, computed_rows(reader, catalogue, experiment.plan, unit));
            if (!difference.empty()) differences.push_back(fmt::format("{} {}: {}", code, unit.target, difference));
            rows += there.size();
            progress.advance(fmt::format("{} {}", code, unit.target));
        }
    }
    if (arguments.common.json)
        std::cout << io::json_text(
            nlohmann::json{{"schema", 1}, {"units", units.size()}, {"rows", rows}, {"differences", differences}});
    else if (differences.empty())
        std::cout << fmt::format("{}: files are as they were sealed; {} of {} recomputed, {} equal\n",
                                 folder.root().string(), units.size(), base::counted(experiment.plan.units(), "unit"),
                                 base::counted(rows, "row"));
    else
        for (const auto& difference : differences) std::cout << difference << "\n";
    return differences.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_verify_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("verify", "Recompute a sample of a finished experiment and compare");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("OUT", arguments->folder, "Folder made by 'mimik run'")->required();
    command->add_option("--experiment", arguments->file, "The experiment file, where it lies elsewhere by now");
    command->add_option("--workspace", arguments->workspace, "The workspace, where it lies elsewhere by now");
    command->add_option("--units", arguments->units, "Units (a target of an expression) to recompute")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    add_seed_option(*command, arguments->seed);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
