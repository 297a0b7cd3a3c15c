#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "cli/command.h"
#include "cli/method_options.h"
#include "evaluation/experiment.h"
#include "io/json_values.h"
#include "report/score_table.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string workspace, output, catalogue_file;
    std::vector<std::string> methods = {"thesis", "default", "mean"};
    evaluation::ExperimentOptions options;
    bool no_reference = false, no_whole_face = false, dry_run = false;
};

int run(Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    const auto catalogue =
        arguments.catalogue_file.empty() ? facs::builtin_catalogue() : facs::read_catalogue(arguments.catalogue_file);
    auto& options = arguments.options;
    refuse_doubles("--method", arguments.methods);
    options.methods.clear();
    for (const auto& name : arguments.methods) options.methods.push_back(evaluation::method_by_name(name));
    for (auto& expression : options.expressions) expression = catalogue.code(expression);
    options.reference = !arguments.no_reference;
    options.whole_face = !arguments.no_whole_face;
    evaluation::check_experiment(workspace, catalogue, options);
    const std::filesystem::path folder = arguments.output;
    if (!folder.empty()) check_output_folder(folder, arguments.dry_run);
    if (arguments.dry_run) {
        const auto estimate = evaluation::estimate_experiment(workspace, options);
        const double seconds = estimate.core_seconds / working_threads();
        if (arguments.common.json)
            std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                      {"dry_run", true},
                                                      {"transfers", estimate.transfers},
                                                      {"seconds", seconds},
                                                      {"megabytes", 1.0}});
        else
            std::cout << fmt::format("{} transfers, about {:.0f} s and less than 1 MB of tables\n", estimate.transfers,
                                     seconds);
        return exit_done;
    }
    const std::size_t steps = evaluation::experiment_steps(workspace, options);
    evaluation::ExperimentReport report;
    {
        Progress progress(arguments.common, "evaluate", steps);
        report = evaluation::run_experiment(workspace, catalogue, options,
                                            [&](const std::string& what) { progress.advance(what); });
    }
    const auto markdown = report::to_markdown(report), json = report::to_json(report);
    std::cout << (arguments.common.json ? json : markdown) << std::flush;
    if (!arguments.output.empty()) {
        base::write_atomically(folder / "scores.md", markdown);
        base::write_atomically(folder / "scores.csv", report::to_csv(report));
        base::write_atomically(folder / "scores.json", json);
    }
    if (!arguments.common.json && !arguments.common.quiet) std::cerr << fmt::format("{:.1f} s\n", report.seconds);
    return report.failures.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_evaluate_command(CLI::App& app, int& exit_code) {
    auto* command =
        app.add_subcommand("evaluate", "Score methods on every ordered pair of subjects beside doing nothing");
    auto arguments = std::make_shared<Arguments>();
    auto& options = arguments->options;
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command->add_option("--method", arguments->methods, "thesis, default (one source), mean (of all other subjects)")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--expression,--au", options.expressions, "AUs and emotions to score")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--max-sources", options.max_sources, "Sources per target; 0 = all other subjects")
        ->capture_default_str();
    command->add_option("--catalogue", arguments->catalogue_file, "Another FACS catalogue (TOML) than the built-in one")
        ->check(CLI::ExistingFile);
    command->add_flag("--no-reference", arguments->no_reference,
                      "Leave out the true-field reference of synthetic databases");
    command->add_flag("--no-whole-face", arguments->no_whole_face, "Score the active zone only (faster)");
    add_output_folder(*command, arguments->output, "Folder for scores.md, scores.csv and scores.json");
    command->add_flag("--dry-run", arguments->dry_run, "Say time and disk, do nothing");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
