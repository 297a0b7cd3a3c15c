#include <algorithm>
#include <memory>
#include <string>

#include <unistd.h>

#include "base/errors.h"
#include "cli/command.h"
#include "cli/help_pages.h"
#include "cli/method_options.h"
#include "cli/option_faults.h"
#include "cli/terminal.h"
#include "report/estimator_table.h"

namespace mimik::cli {

void add_help_command(CLI::App& app, int& exit_code) {
    struct Arguments {
        std::string command, format = "text";
    };
    const auto arguments = std::make_shared<Arguments>();
    auto* command = app.add_subcommand("help", "Say what a command does; the manual, the words for a shell");
    command->add_option(
        "COMMAND", arguments->command,
        "Without it, the list of all commands; methods: all of --method; estimators: what 'mimik evaluate' "
        "can measure");
    command
        ->add_option("--format", arguments->format,
                     "text, or man, bash, zsh: of the program as a whole; json: of estimators")
        ->check(CLI::IsMember(std::vector<std::string>{"text", "man", "bash", "zsh", "json"}))
        ->capture_default_str();
    command->callback([arguments, &app, &exit_code] {
        exit_code = exit_done;
        const auto& name = arguments->command;
        if (arguments->format == "json") {
            if (name != "estimators")
                throw InputError("--format json is of 'mimik help estimators' alone; leave it out");
            raw_output() << report::estimators_json();
            return;
        }
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
        if (name == "methods") {
            raw_output() << methods_text(shows_colours(STDOUT_FILENO));
            return;
        }
        if (name == "estimators") {
            raw_output() << report::estimators_markdown();
            return;
        }
        for (const auto* one : app.get_subcommands({}))
            if (one->get_name() == name) return print_help(*one);
        throw InputError(unknown_command(app, name));
    });
}

}  // namespace mimik::cli
