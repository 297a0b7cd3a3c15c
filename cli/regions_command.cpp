#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "cli/command.h"
#include "cli/regions_file.h"
#include "io/json_values.h"
#include "modeling/average_fingerprint.h"
#include "modeling/region_labels.h"
#include "preprocessing/workspace.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string workspace, output;
    bool force = false;
};

int run(const Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    const auto& average = workspace.average();
    const auto labels = modeling::label_regions(average.grid, average.landmarks);
    const auto file =
        arguments.output.empty() ? default_regions_file(workspace) : std::filesystem::path(arguments.output);
    const auto text = modeling::encode_region_labels(labels, modeling::average_fingerprint(average));
    if (!arguments.force && std::filesystem::exists(file) && base::read_text(file) != text)
        throw InputError(
            fmt::format("{}: differs from what would be written; if nobody's work is in it, replace it with --force, "
                        "else give another file with -o",
                        file.string()));
    base::write_atomically(file, text);
    std::map<std::string, std::size_t> count;
    for (const auto& label : labels.label)
        if (!label.empty()) ++count[label];
    if (arguments.common.json) {
        std::cout << io::json_text(nlohmann::json{{"schema", 1}, {"file", file.string()}, {"vertices", count}});
    } else {
        for (const auto& [name, vertices] : count) std::cout << fmt::format("{:<14} {:>6} vertices\n", name, vertices);
        std::cout << fmt::format("{}\n", file.string());
    }
    return exit_done;
}

}  // namespace

void add_regions_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("regions", "Write the regions of the average face to a file, to be edited");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command->add_option("-o,--output", arguments->output,
                        "CSV row,col,region (default: average/regions.csv in the workspace)");
    command->add_flag("--force", arguments->force, "Replace a file that differs: somebody may have edited it");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
