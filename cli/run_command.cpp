#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/folder_lock.h"
#include "base/parallel.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/experiment_folder.h"
#include "cli/notes.h"
#include "cli/per_vertex_files.h"
#include "cli/report_page.h"
#include "cli/run_steps.h"
#include "database/known_databases.h"
#include "database/scan_database.h"
#include "evaluation/case_store.h"
#include "evaluation/comparison.h"
#include "evaluation/experiment.h"
#include "evaluation/experiment_file.h"
#include "evaluation/source_dependence.h"
#include "io/json_values.h"
#include "preprocessing/preprocess_run.h"
#include "report/comparison_table.h"
#include "report/latex_tables.h"
#include "report/rows_files.h"
#include "report/score_table.h"
#include "report/source_dependence_table.h"

namespace mimik::cli {
namespace {

namespace fs = std::filesystem;
using Arguments = RunArguments;

}  // namespace

evaluation::ExperimentFile experiment_of(const Arguments& arguments) {
    auto file = evaluation::read_experiment_file(arguments.file);
    if (!arguments.database.empty()) {
        file.database = arguments.database;
        file.workspace.clear();
    }
    if (!arguments.workspace.empty()) {
        file.workspace = arguments.workspace;
        file.database.clear();
    }
    if (file.database.empty() && file.workspace.empty())
        throw InputError(fmt::format("{}: names no 'database' and no 'workspace'; write one, or give --database DIR",
                                     arguments.file));
    return file;
}

namespace {

/// The expressions of the file and, of emotions, their AUs: zones are made of those, too.
std::vector<facs::Expression> scans_needed(const evaluation::ExperimentFile& file,
                                           const facs::FacsCatalogue& catalogue) {
    std::vector<facs::Expression> needed;
    const auto add = [&](const facs::Expression& expression) {
        if (std::find(needed.begin(), needed.end(), expression) == needed.end()) needed.push_back(expression);
    };
    for (const auto& word : file.expressions) {
        const auto expression =
            catalogue.find_expression(word) ? catalogue.expression(word) : *facs::parse_expression(word);
        add(expression);
        if (expression.own_word()) continue;
        const auto named = catalogue.expression(word);
        if (named.units().size() > 1)
            for (const auto& unit : named.units()) add(facs::Expression::of_units({{unit.unit, unit.side, false}}));
    }
    return needed;
}

}  // namespace

std::vector<std::string> preprocess(const Arguments& arguments, const evaluation::ExperimentFile& file,
                                    const facs::FacsCatalogue& catalogue, const fs::path& workspace) {
    refuse_workspace(file.database);
    const auto unit = io::parse_length_unit(file.unit.empty() ? "mm" : file.unit);
    const auto database = database::open_database(file.database, unit);
    database::remember_database(database.root);
    preprocessing::PreprocessOptions options;
    std::vector<facs::Expression> wanted;
    try {
        wanted = scans_needed(file, catalogue);
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: {}", file.place("expressions"), e.what()));
    }
    for (const auto& expression : wanted) {
        const bool there = std::any_of(database.scans.begin(), database.scans.end(),
                                       [&](const auto& scan) { return scan.id.expression() == expression; });
        if (there) options.expressions.push_back(expression);
    }
    if (options.expressions.empty())
        throw InputError(fmt::format("{}: no scan of {} shows one of the expressions", file.place("expressions"),
                                     file.database.string()));
    preprocessing::check_workspace_place(database, workspace);
    const auto scans = preprocessing::scans_to_preprocess(database, workspace, options);
    fs::create_directories(workspace);
    const base::FolderLock lock(workspace, base::FolderLock::Use::write);
    Progress progress(arguments.common, "preprocess", scans.size());
    const auto report = preprocessing::preprocess_database(
        database, workspace, catalogue, options, [&](const std::string& scan) { progress.advance(scan); }, &lock);
    std::vector<std::string> failures;
    for (const auto& failure : report.failures) failures.push_back(fmt::format("{}: {}", failure.scan, failure.reason));
    for (const auto& subject : report.left_out)
        failures.push_back(fmt::format("{}: no usable neutral face, so the subject was left out", subject));
    return failures;
}

namespace {

/// After each expression what each method explains of it, as far as it is known.
void say_expression(const std::string& code, const evaluation::ScoreTable& table,
                    const evaluation::ExperimentPlan& plan) {
    std::string line = code + ":";
    for (const auto& method : plan.methods)
        for (const double magnitude : plan.magnitudes_of(*method)) {
            const auto variant = evaluation::variant_of(method->name(), magnitude);
            const auto found = table.find(variant);
            if (found == table.end() || !found->second.contains(code) || method->name() == evaluation::baseline_method)
                continue;
            if (const auto& explained = found->second.at(code).explained)
                line += fmt::format(" {} {:.3f}", variant, *explained);
        }
    std::cerr << line << "\n";
}

}  // namespace

std::string provenance(const Arguments& arguments, const evaluation::ExperimentFile& file, const fs::path& workspace,
                       double seconds) {
    constexpr std::size_t longest_host = 256;
    std::string host(longest_host, '\0');
    if (::gethostname(host.data(), host.size() - 1) != 0) host = "unknown";
    host = host.c_str();  // up to its end
    const auto absolute = [](const fs::path& path) { return path.empty() ? "" : fs::absolute(path).string(); };
    return io::json_text(
        nlohmann::ordered_json{{"schema", 1},
                               {"command", command_line()},
                               {"host", host},
                               {"ended", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
                               {"seconds_of_this_run", seconds},
                               {"threads", base::thread_count()},
                               {"experiment", absolute(arguments.file)},
                               {"database", absolute(file.database)},
                               {"workspace", absolute(workspace)}});
}

namespace {

/// What chance could have made of the differences; empty where no two methods have a case in common.
std::string write_statistics(const ExperimentFolder& folder, const evaluation::CaseStore& store,
                             const evaluation::ExperimentFile& file) {
    evaluation::ComparisonOptions options;
    options.seed = file.seed;
    options.resamples = file.resamples;
    options.confidence = file.confidence;
    const auto comparison = evaluation::compare_methods([&](const auto& visit) { store.read(visit); }, options);
    base::write_atomically(folder.root() / "statistics" / "methods.csv", report::methods_csv(comparison));
    base::write_atomically(folder.root() / "statistics" / "differences.csv", report::differences_csv(comparison));
    base::write_atomically(folder.root() / "tables" / "intervals.tex", report::intervals_latex(comparison, options));
    const auto dependences = evaluation::source_dependence([&](const auto& visit) { store.read(visit); }, options);
    base::write_atomically(folder.root() / "statistics" / "source_dependence.csv",
                           report::source_dependence_csv(dependences));
    const auto whose = report::to_markdown(dependences);
    return report::to_markdown(comparison, options) + (whose.empty() ? "" : "\n" + whose);
}

}  // namespace

void write_results(const ExperimentFolder& folder, const evaluation::CaseStore& store,
                   const evaluation::ExperimentFile& file, const evaluation::ExperimentReport& report) {
    const auto read = [&](const auto& visit) { store.read(visit); };
    report::write_rows_csv(folder.rows(), read);
    report::write_rows_sqlite(folder.root() / "rows.sqlite", read);
    base::write_atomically(folder.root() / "tables" / "explained.tex", report::explained_latex(report));
    base::write_atomically(folder.root() / "tables" / "error_mm.tex", report::error_latex(report));
    base::write_atomically(folder.root() / "scores.json", report::to_json(report));
    base::write_atomically(folder.root() / "scores.csv", report::to_csv(report));
    const auto statistics = write_statistics(folder, store, file);
    base::write_atomically(folder.summary(), report::to_markdown(report) + "\n" + statistics);
}

int say_result(const Arguments& arguments, const ExperimentFolder& folder) {
    if (arguments.common.json)
        std::cout << base::read_text(folder.root() / "scores.json", io::most_json_bytes);
    else
        std::cout << base::read_text(folder.summary(), io::most_json_bytes);
    std::cout << std::flush;
    const auto scores =
        io::parse_json(base::read_text(folder.root() / "scores.json", io::most_json_bytes), "scores.json");
    return scores.at("failures").empty() ? exit_done : exit_done_with_failures;
}

namespace {

int say_plan(const Arguments& arguments, const evaluation::ExperimentPlan& plan) {
    const auto estimate = evaluation::estimate(plan);
    const double seconds = estimate.core_seconds / working_threads();
    if (arguments.common.json)
        std::cout << nlohmann::json{{"schema", 1},
                                    {"dry_run", true},
                                    {"units", plan.units()},
                                    {"transfers", estimate.transfers},
                                    {"seconds", seconds}}
                         .dump(1)
                  << "\n";
    else
        std::cout << fmt::format("{}, {}; about {:.0f} s in all\n", base::counted(plan.units(), "unit"),
                                 base::counted(estimate.transfers, "transfer"), seconds);
    return exit_done;
}

evaluation::ExperimentReport run_units(const Arguments& arguments, const evaluation::PerformanceReader& reader,
                                       const facs::FacsCatalogue& catalogue, const evaluation::ExperimentPlan& plan,
                                       evaluation::CaseStore& store) {
    Progress progress(arguments.common, "run", plan.units());
    evaluation::RunWatch watch;
    watch.unit = [&](const std::string& what) { progress.advance(what); };
    if (!arguments.common.quiet && !arguments.common.json)
        watch.expression = [&](const std::string& code, const evaluation::ScoreTable& table) {
            say_expression(code, table, plan);
        };
    return evaluation::run_experiment(reader, catalogue, plan, store, watch);
}

int run(const Arguments& arguments) {
    if (arguments.only_preprocess) return run_only_preprocess(arguments);
    if (!arguments.shard.empty()) return run_shard(arguments);
    const auto start = std::chrono::steady_clock::now();
    const auto file = experiment_of(arguments);
    const ExperimentFolder folder(arguments.output);
    const auto catalogue = catalogue_of(file);
    const auto place = workspace_of(file, folder);
    check_output_folder(folder.root(), arguments.dry_run);
    if (arguments.dry_run && file.workspace.empty() && !base::is_there(place / "workspace.json")) {
        std::cout << fmt::format(
            "{}: the scans of {} are still to be preprocessed; 'mimik preprocess {} -o {} --dry-run' "
            "says what that takes\n",
            arguments.file, file.database.string(), file.database.string(), place.string());
        return exit_done;
    }
    std::unique_ptr<const base::FolderLock> lock;
    if (!arguments.dry_run) lock = std::make_unique<base::FolderLock>(folder.root(), base::FolderLock::Use::write);
    if (arguments.anew && !arguments.dry_run) folder.clear();
    std::vector<std::string> unusable;
    if (file.workspace.empty() && !arguments.dry_run && !folder.whole())
        unusable = preprocess(arguments, file, catalogue, place);

    const preprocessing::Workspace workspace(place);
    const evaluation::PerformanceReader reader(workspace);
    const auto experiment = planned(file, reader, catalogue);
    if (arguments.dry_run) return say_plan(arguments, experiment.plan);
    folder.claim(experiment.identity);
    if (!folder.whole()) {
        {
            auto store = evaluation::CaseStore::gone_on_with(folder.part());
            if (store.units() > 0 && !arguments.common.quiet)
                std::cerr << fmt::format("going on after {} of an earlier run\n",
                                         base::counted(store.units(), "stored unit"));
            auto report = run_units(arguments, reader, catalogue, experiment.plan, store);
            report.failures.insert(report.failures.begin(), unusable.begin(), unusable.end());
            if (!arguments.common.quiet) say_notes(report.remarks);
            for (auto& failure : write_per_vertex(folder.root(), file, reader, catalogue, experiment.plan))
                report.failures.push_back(std::move(failure));
            write_results(folder, store, file, report);
        }
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        base::write_atomically(folder.provenance(), provenance(arguments, file, place, seconds));
        folder.seal();
    } else {
        if (const auto damage = folder.damage(); !damage.empty())
            throw InputError(fmt::format("{}: {}; give --anew to run again, or another folder", folder.root().string(),
                                         fmt::join(damage, "; ")));
        if (!arguments.common.quiet)
            std::cerr << fmt::format("{}: was run already, nothing is left to do\n", folder.root().string());
    }
    std::error_code none;
    fs::remove(folder.part(), none);
    std::string no_page;
    if (!base::is_there(folder.page()))
        no_page = make_page(arguments.common, folder, arguments.file, catalogue, reader, experiment.plan);
    const int code = say_result(arguments, folder);
    if (no_page.empty()) return code;
    say_failures({no_page});
    return exit_done_with_failures;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
    auto* command =
        app.add_subcommand("run", "Run an experiment file: rows, tables and scores; goes on where it stopped");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("EXPERIMENT", arguments->file, "Experiment file (TOML, docs/experiments.md)")->required();
    add_output_folder(*command, arguments->output, "Folder for the results; a second run goes on where the first ended")
        ->required();
    auto* database = command->add_option("--database", arguments->database,
                                         "Database to preprocess and use, whatever the file says");
    command->add_option("--workspace", arguments->workspace, "Workspace to use, whatever the file says")
        ->excludes(database);
    auto* anew = command->add_flag("--anew", arguments->anew,
                                   "Throw away what an earlier run left in the folder, but its workspace");
    auto* dry_run =
        command->add_flag("--dry-run", arguments->dry_run, "Check the file and say time and units, do nothing");
    auto* shard = command
                      ->add_option("--shard", arguments->shard,
                                   "Do the i-th of n parts alone, such as 3/20; 'mimik merge' makes one of all")
                      ->excludes(anew)
                      ->excludes(dry_run);
    command
        ->add_flag("--only-preprocess", arguments->only_preprocess,
                   "Do what all shards have in common, once before them, and stop")
        ->excludes(shard)
        ->excludes(anew)
        ->excludes(dry_run);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
