#include <algorithm>
#include <memory>
#include <string>
#include <vector>

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
        std::vector<std::string> command;
        std::string format = "text";
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
            if (name != std::vector<std::string>{"estimators"})
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
        if (name == std::vector<std::string>{"methods"}) {
            raw_output() << methods_text(shows_colours(STDOUT_FILENO));
            return;
        }
        if (name == std::vector<std::string>{"estimators"}) {
            raw_output() << report::estimators_markdown();
            return;
        }
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
