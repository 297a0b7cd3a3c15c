#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/command.h"
#include "cli/expression_names.h"
#include "cli/method_options.h"
#include "cli/notes.h"
#include "cli/subject_names.h"
#include "io/json_values.h"
#include "modeling/source_expression.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    MethodArguments method;
    std::string workspace, output;
    std::vector<std::string> sources = {"mean"}, expressions;
};

int run(Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    const auto catalogue = arguments.method.catalogue();
    const std::filesystem::path folder = arguments.output.empty()
                                             ? workspace.root() / "models" / arguments.method.variant_name()
                                             : std::filesystem::path(arguments.output);
    // A word mistyped is found out before any work.
    const auto expressions = expressions_named(workspace, catalogue, "--expression", arguments.expressions);
    for (auto& source : arguments.sources) {
        source = subject_named(workspace, source);
        modeling::check_source(workspace, {source, {}}, arguments.method.model_options());
        if (source != "mean") (void)workspace.neutral(source);
    }
    refuse_doubles("--source", arguments.sources);
    check_output_folder(folder, false);

    const auto provenance = arguments.method.provenance(catalogue, workspace.average());
    auto written = nlohmann::json::array();
    std::vector<std::string> failures;
    Progress progress(arguments.common, "model", arguments.sources.size() * expressions.size());
    for (const auto& source : arguments.sources) {
        for (const auto& expression : expressions) {
            try {
                auto model = modeling::model_from_workspace(workspace, catalogue, expression, {source, {}},
                                                            arguments.method.model_options());
                model.provenance = provenance;
                const auto file = folder / source / (model.expression.name() + ".json");
                modeling::write_expression_model(file, model);
                for (const auto& scan : model.unusable_scans)
                    failures.push_back(fmt::format("{}: left out of the mean: {}", model.expression.name(), scan));
                written.push_back({{"file", file.string()},
                                   {"expression", model.expression.name()},
                                   {"source", source},
                                   {"points", model.points.size()},
                                   {"left_out", model.left_out},
                                   {"largest_displacement_mm", model.largest_displacement_mm()}});
            } catch (const std::exception& e) {
                failures.push_back(fmt::format("{} of {}: {}", expression.code(), source, e.what()));
            }
            progress.advance(fmt::format("{} {}", source, expression.code()));
        }
    }
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::json{{"schema", 1}, {"models", written}, {"failures", failures}});
    else
        std::cout << fmt::format("{} in {}\n", base::counted(written.size(), "model"), folder.string());
    say_failures(failures);
    return failures.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_model_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("model", "Measure expressions as control points, a small file each");
    auto arguments = std::make_shared<Arguments>();
    arguments->expressions = {"1", "2", "4", "12", "14", "15", "17", "20"};
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command->add_option("--source", arguments->sources, "Subjects, or mean (of all)")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--expression,--au", arguments->expressions, "AUs and emotions")
        ->delimiter(',')
        ->capture_default_str();
    add_output_folder(*command, arguments->output, "Folder (default: models/<method and switches> in the workspace)");
    arguments->method.add_to(*command);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
