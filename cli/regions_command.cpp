#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "modeling/region_labels.h"
#include "preprocessing/workspace.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string workspace, output;
};

int run(const Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    const auto& average = workspace.average();
    const auto labels = modeling::label_regions(average.grid, average.landmarks);
    const std::filesystem::path file = arguments.output.empty() ? workspace.root() / "average" / "regions.csv"
                                                                : std::filesystem::path(arguments.output);
    modeling::write_region_labels(file, labels);
    std::map<std::string, std::size_t> count;
    for (const auto& label : labels.label)
        if (!label.empty()) ++count[label];
    if (arguments.common.json) {
        std::cout << nlohmann::json{{"schema", 1}, {"file", file.string()}, {"vertices", count}}.dump(1) << '\n';
    } else {
        for (const auto& [name, vertices] : count) std::cout << fmt::format("{:<14} {:>6} vertices\n", name, vertices);
        std::cout << fmt::format("{}\n", file.string());
    }
    return exit_done;
}

}  // namespace

void add_regions_command(CLI::App& app, int& exit_code) {
    auto* command =
        app.add_subcommand("regions", "Write the regions of the average face as a label file that can be edited");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command->add_option("-o,--output", arguments->output,
                        "CSV row,col,region (default: average/regions.csv in the workspace)");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
