#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "cli/command.h"
#include "cli/experiment_folder.h"
#include "evaluation/run_comparison.h"
#include "io/json_values.h"
#include "report/rows_files.h"
#include "report/run_comparison_table.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::vector<std::string> folders, names;
    std::string output;
    evaluation::ComparisonOptions options;
};

std::vector<evaluation::NamedRun> named_runs(const Arguments& arguments) {
    if (!arguments.names.empty() && arguments.names.size() != arguments.folders.size())
        throw InputError(fmt::format("--name: gives {} names for {} runs; give one for each", arguments.names.size(),
                                     arguments.folders.size()));
    std::vector<evaluation::NamedRun> runs;
    for (std::size_t r = 0; r < arguments.folders.size(); ++r) {
        const ExperimentFolder folder(arguments.folders[r]);
        if (!folder.whole())
            throw InputError(fmt::format("{}: is no finished experiment (no manifest.json); finish it with 'mimik run'",
                                         folder.root().string()));
        auto name = std::filesystem::absolute(folder.root()).lexically_normal();
        if (!name.has_filename()) name = name.parent_path();
        runs.push_back({arguments.names.empty() ? name.filename().string() : arguments.names[r],
                        [rows = folder.rows()](const auto& visit) { report::read_rows_csv(rows, visit); }});
    }
    return runs;
}

nlohmann::ordered_json to_json(const evaluation::RunComparison& comparison) {
    auto methods = nlohmann::ordered_json::array();
    for (const auto& one : comparison.methods) {
        auto runs = nlohmann::ordered_json::array();
        for (const auto& own : one.runs) {
            if (!own) {
                runs.push_back(nullptr);
                continue;
            }
            nlohmann::ordered_json run{{"cases", own->cases}, {"targets", own->targets}, {"error", own->error}};
            if (own->explained) run["explained"] = *own->explained;
            if (own->explained_interval)
                run["explained_interval"] = {own->explained_interval->low, own->explained_interval->high};
            runs.push_back(run);
        }
        methods.push_back(
            {{"region", one.region}, {"expression", one.expression}, {"method", one.method}, {"runs", runs}});
    }
    auto differences = nlohmann::ordered_json::array();
    for (const auto& one : comparison.differences) {
        nlohmann::ordered_json difference{{"region", one.region},
                                          {"expression", one.expression},
                                          {"first", one.first},
                                          {"second", one.second},
                                          {"pairing", to_string(one.pairing)},
                                          {"pairs", one.pairs},
                                          {"targets", one.targets},
                                          {"difference", one.difference},
                                          {"p", one.p},
                                          {"q", one.q}};
        if (one.interval) difference["interval"] = {one.interval->low, one.interval->high};
        differences.push_back(difference);
    }
    return {{"schema", 1},
            {"runs", comparison.runs},
            {"unit", comparison.unit},
            {"methods", methods},
            {"differences", differences}};
}

int run(const Arguments& arguments) {
    check_by_option({{"estimator", "--estimator"},
                     {"regions", "--region"},
                     {"metric", "--metric"},
                     {"resamples", "--resamples"},
                     {"confidence", "--confidence"}},
                    [&] { arguments.options.check(); });
    const auto comparison = evaluation::compare_runs(named_runs(arguments), arguments.options);
    if (!arguments.output.empty()) base::write_atomically(arguments.output, report::run_comparison_csv(comparison));
    if (arguments.common.json)
        std::cout << io::json_text(to_json(comparison));
    else
        std::cout << report::to_markdown(comparison, arguments.options);
    return exit_done;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("compare", "Set finished runs of experiments side by side, method by method");
    auto arguments = std::make_shared<Arguments>();
    auto& options = arguments->options;
    command->add_option("RUN", arguments->folders, "Folders of 'mimik run': the first is what others are compared with")
        ->required();
    command->add_option("--name", arguments->names, "What tables call the runs; else the names of their folders")
        ->delimiter(',');
    command->add_option("--region", options.regions, "Of the rows: zone, face, or one that the experiment asked for")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--estimator", options.estimator, "Whose rows")->capture_default_str();
    command->add_option("--metric", options.metric, "An error of them: smaller is truer")->capture_default_str();
    command->add_option("--resamples", options.resamples, "Of intervals")->capture_default_str();
    command->add_option("--confidence", options.confidence, "Of intervals")->capture_default_str();
    command->add_option("--seed", options.seed, "Of resampling")->capture_default_str();
    command->add_option("-o,--output", arguments->output, "CSV file to write, beside the tables on the screen");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
