#include <memory>
#include <vector>

#include "cli/command.h"
#include "cli/figure_options.h"
#include "cli/figure_start.h"

namespace mimik::cli {

void add_figure_command(CLI::App& app, int& /*exit_code*/) {
    auto* command = app.add_subcommand(
        "figure", "Draw any meshes side by side, without needing a display (figures of a workspace: 'figures')");
    const auto arguments = std::make_shared<FigureArguments>();
    add_figure_options(*command, *arguments);
    command->callback([arguments] {
        check_figure_options(*arguments);
        // The other program reads the same words again, from behind "figure".
        const auto& words = command_line();
        become_figure_program({words.begin() + 1, words.end()});
    });
}

}  // namespace mimik::cli
