#include "cli/command.h"
#include "cli/figure_start.h"

namespace mimik::cli {

void add_figure_command(CLI::App& app, int& /*exit_code*/) {
    auto* command = app.add_subcommand("figure", "Draw faces side by side (see 'mimik figure --help')");
    command->set_help_flag();  // the other program answers --help
    command->prefix_command();
    command->callback([command] { become_figure_program(command->remaining()); });
}

}  // namespace mimik::cli
