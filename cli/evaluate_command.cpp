#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/expression_names.h"
#include "cli/method_options.h"
#include "cli/notes.h"
#include "evaluation/case_store.h"
#include "evaluation/estimator_check.h"
#include "evaluation/experiment.h"
#include "io/json_values.h"
#include "report/estimator_table.h"
#include "report/score_table.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string workspace, output, catalogue_file, zones, emotions = facs::usual_emotion_set;
    std::vector<std::string> methods, expressions, estimators;
    std::string alignment = "given";
    evaluation::ExperimentOptions options;
    bool no_reference = false, no_whole_face = false, dry_run = false, on_itself = false, check_estimators = false;
};

int say_plan(const Arguments& arguments, const evaluation::ExperimentPlan& plan) {
    const auto estimate = evaluation::estimate(plan);
    const double seconds = estimate.core_seconds / working_threads();
    constexpr double bytes_per_transfer = 1500;  // thirteen lines of cases.csv
    const double megabytes = 1.0 + static_cast<double>(estimate.transfers) * bytes_per_transfer / 1e6;
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"dry_run", true},
                                                  {"transfers", estimate.transfers},
                                                  {"seconds", seconds},
                                                  {"megabytes", megabytes}});
    else
        std::cout << fmt::format("{}, about {:.0f} s and {:.0f} MB of tables\n",
                                 base::counted(estimate.transfers, "transfer"), seconds, megabytes);
    return exit_done;
}

evaluation::ZoneSource zones_named(const std::string& name) {
    using evaluation::ZoneSource;
    for (const auto source : {ZoneSource::truth, ZoneSource::data, ZoneSource::catalogue})
        if (name == to_string(source)) return source;
    return ZoneSource::automatic;
}

/// --check-estimators without --estimator: what a scan shows, and what reading the truth would.
const std::vector<std::string> checked_estimators = {
    "point-to-surface", "point-to-point", "signed",  "normal-angle", "curvature",
    "along-normal",     "registered",     "reverse", "hausdorff",    "landmarks/point-to-surface"};

void read_estimators(Arguments& arguments) {
    auto& options = arguments.options;
    refuse_doubles("--estimator", arguments.estimators);
    refuse_doubles("--region", options.regions);
    if (arguments.check_estimators && arguments.estimators.empty()) arguments.estimators = checked_estimators;
    options.estimators.clear();
    for (const auto& name : arguments.estimators) options.estimators.push_back(evaluation::estimator_by_name(name));
    options.alignment = evaluation::alignment_by_name(arguments.alignment);
    const auto& regions = options.regions;
    if (arguments.check_estimators && std::find(regions.begin(), regions.end(), "zone") == regions.end())
        throw InputError(
            "--check-estimators compares errors in the zone, where the true ones are known; add zone to --region");
}

/// How well each estimator follows the true error, from the cases on disk.
void write_estimator_check(const std::filesystem::path& folder, const std::filesystem::path& cases) {
    const auto check =
        evaluation::check_estimators([&](const auto& visit) { (void)evaluation::read_case_rows(cases, visit); });
    base::write_atomically(folder / "estimators.md", report::to_markdown(check));
    base::write_atomically(folder / "estimators.csv", report::to_csv(check));
}

int run(Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    auto catalogue =
        arguments.catalogue_file.empty() ? facs::builtin_catalogue() : facs::read_catalogue(arguments.catalogue_file);
    if (arguments.emotions != facs::usual_emotion_set) catalogue = catalogue.with_emotions(arguments.emotions);
    auto& options = arguments.options;
    if (arguments.methods.empty()) {
        arguments.methods = {"thesis", "default"};
        if (!arguments.on_itself) arguments.methods.emplace_back("mean");
    }
    options.on_itself = arguments.on_itself;
    refuse_doubles("--method", arguments.methods);
    options.methods.clear();
    for (const auto& name : arguments.methods) options.methods.push_back(animation::method_by_name(name));
    options.expressions = expressions_named(workspace, catalogue, "--expression", arguments.expressions);
    options.zones = zones_named(arguments.zones);
    read_estimators(arguments);
    options.reference = !arguments.no_reference;
    options.whole_face = !arguments.no_whole_face;
    const evaluation::PerformanceReader reader(workspace);
    if (arguments.check_estimators && !reader.has_truth())
        throw InputError(fmt::format(
            "--check-estimators needs a truth, and {} has none; take a workspace of a database that 'mimik synthesize' "
            "made",
            workspace.database_root().string()));
    evaluation::ExperimentPlan plan;
    check_by_option({{"max_sources", "--max-sources"}, {"on_itself", "--on-itself"}},
                    [&] { plan = evaluation::plan_experiment(workspace, catalogue, options, reader.has_truth()); });
    const std::filesystem::path folder =
        arguments.output.empty() ? workspace.root() / "scores" : std::filesystem::path(arguments.output);
    check_output_folder(folder, arguments.dry_run);
    if (arguments.dry_run) return say_plan(arguments, plan);
    const auto cases = folder / (options.on_itself ? "cases_on_itself.csv" : "cases.csv");
    evaluation::ExperimentReport report;
    {
        Progress progress(arguments.common, "evaluate", plan.units());
        report = evaluation::run_experiment(reader, catalogue, plan, cases,
                                            [&](const std::string& what) { progress.advance(what); });
    }
    const auto markdown = report::to_markdown(report), json = report::to_json(report);
    const auto stem = folder / (options.on_itself ? "on_itself" : "scores");
    base::write_atomically(stem.string() + ".md", markdown);
    base::write_atomically(stem.string() + ".csv", report::to_csv(report));
    base::write_atomically(stem.string() + ".json", json);
    if (arguments.check_estimators) write_estimator_check(folder, cases);
    std::cout << (arguments.common.json ? json : markdown) << std::flush;
    if (!arguments.common.quiet) say_notes(report.remarks);
    if (!arguments.common.json && !arguments.common.quiet)
        std::cerr << fmt::format("{:.1f} s; every case is in {}\n", report.seconds, cases.string());
    return report.failures.empty() ? exit_done : exit_done_with_failures;
}

void add_estimator_options(CLI::App& command, Arguments& arguments) {
    auto& options = arguments.options;
    command
        .add_option("--estimator", arguments.estimators,
                    "Further rows for cases.csv, such as signed or landmarks/point-to-surface ('mimik help estimators' "
                    "has all)")
        ->delimiter(',');
    command.add_option("--region", options.regions, "Where those estimators look: zone, face, upper, nose, ...")
        ->delimiter(',')
        ->capture_default_str();
    command.add_option("--metric", options.metrics.metrics, "Which figures they give: mean, rms, max, curve, ...")
        ->delimiter(',')
        ->capture_default_str();
    command.add_flag("--area-weighted", options.metrics.area_weighted,
                     "Weigh their vertices by the area about each on the neutral face");
    command
        .add_option("--alignment", arguments.alignment,
                    "What brings the real scan to the neutral one; given: the true pose, or else as preprocessed")
        ->check(CLI::IsMember(evaluation::known_alignments()))
        ->capture_default_str();
    command.add_flag("--check-estimators", arguments.check_estimators,
                     "Compare estimators with the truth: estimators.md, estimators.csv");
}

}  // namespace

void add_evaluate_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("evaluate", "Score methods on every ordered pair of subjects");
    auto arguments = std::make_shared<Arguments>();
    auto& options = arguments->options;
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command
        ->add_option("--method", arguments->methods,
                     "Methods to score; 'mimik help methods' lists them (mean is --source mean of the other commands)")
        ->delimiter(',')
        ->check(CLI::IsMember(method_names()))
        ->default_str("thesis,default,mean");
    command->add_flag("--on-itself", arguments->on_itself,
                      "Score each source on itself, and nobody on others; into on_itself.md, .csv, .json and "
                      "cases_on_itself.csv");
    for (const auto& expression : evaluation::ExperimentOptions::thesis_expressions())
        arguments->expressions.push_back(expression.code());
    command->add_option("--expression,--au", arguments->expressions, "AUs and emotions to score")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--max-sources", options.max_sources, "Sources per target; 0 = all other subjects")
        ->capture_default_str();
    command
        ->add_option(
            "--zones", arguments->zones,
            "Where methods are compared: where the truth, the data or the built-in catalogue say that skin moves "
            "(default: truth where there is one, else data)")
        ->check(CLI::IsMember({"truth", "data", "catalogue"}));
    add_estimator_options(*command, *arguments);
    command->add_option("--catalogue", arguments->catalogue_file,
                        "Another FACS catalogue (TOML) than the built-in one");
    command->add_option("--emotions", arguments->emotions, "What emotions are made of: emfacs, thesis (Table 3-3)")
        ->capture_default_str();
    command->add_flag("--no-reference", arguments->no_reference,
                      "Leave out the true-field reference of synthetic databases");
    command->add_flag("--no-whole-face", arguments->no_whole_face, "Score the active zone only (faster)");
    add_output_folder(*command, arguments->output,
                      "Folder for scores.md, scores.csv, scores.json and cases.csv (default: scores in the workspace)");
    command->add_flag("--dry-run", arguments->dry_run, "Say time and disk, do nothing");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
