#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/errors.h"
#include "cli/command.h"
#include "cli/help_pages.h"
#include "cli/option_faults.h"
#include "cli/terminal.h"

namespace mimik::cli {

void add_help_command(CLI::App& app, int& exit_code) {
    struct Arguments {
        std::vector<std::string> command;
        std::string format = "text";
    };
    const auto arguments = std::make_shared<Arguments>();
    auto* command = app.add_subcommand("help", "Say what a command does; the manual, the words for a shell");
    command->add_option("COMMAND", arguments->command, "Without it, the list of all commands");
    command->add_option("--format", arguments->format, "text, or man, bash, zsh: of the program as a whole")
        ->check(CLI::IsMember(std::vector<std::string>{"text", "man", "bash", "zsh"}))
        ->capture_default_str();
    command->callback([arguments, &app, &exit_code] {
        exit_code = exit_done;
        const auto& name = arguments->command;
        if (arguments->format != "text") {
            if (!name.empty()) throw InputError("--format is of the program as a whole; give it without a command");
            const auto program = page_of(app, app.get_name());
            const bool manual = arguments->format == "man";
            raw_output() << (manual                        ? manual_page(program, MIMIK_VERSION)
                             : arguments->format == "bash" ? bash_completion(program)
                                                           : zsh_completion(program));
            return;
        }
        if (name.empty()) return print_help(app);
        const CLI::App* called = &app;
        for (const auto& word : name) {
            const auto commands = called->get_subcommands({});
            const auto it = std::find_if(commands.begin(), commands.end(),
                                         [&](const CLI::App* one) { return one->get_name() == word; });
            if (it == commands.end()) throw InputError(unknown_command(*called, word));
            called = *it;
        }
        print_help(*called);
    });
}

}  // namespace mimik::cli
