#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace mimik::cli {

/// What is said of an option or an argument, wherever it is said: help, manual page, completion, errors.
struct OptionPage {
    std::vector<std::string> names;    ///< "-o", "--output"; of an argument its one name, "WORK"
    std::string value;                 ///< "TEXT", "N", "X" the choices "sum|parallel", of many NAME; empty: a flag
    std::vector<std::string> choices;  ///< empty: anything
    std::string help, fallback, group;
    bool required = false, repeats = false;

    [[nodiscard]] bool is_argument() const { return !names.front().starts_with('-'); }
};

struct CommandPage {
    std::string name;  ///< "mimik animate"
    std::string description, footer;
    std::vector<OptionPage> arguments, options;
    std::vector<CommandPage> commands;  ///< of the program itself
};

[[nodiscard]] OptionPage page_of(const CLI::Option& option);
[[nodiscard]] CommandPage page_of(const CLI::App& command, const std::string& name);

/// "mimik animate WORK --target TEXT -o TEXT [OPTIONS]"
[[nodiscard]] std::string usage(const CommandPage& page);

/// What --help prints.
[[nodiscard]] std::string help_text(const CommandPage& page, bool colours);
/// The same of the program and all its commands for `man` (roff), and as words that a shell completes.
[[nodiscard]] std::string manual_page(const CommandPage& program, const std::string& version);
[[nodiscard]] std::string bash_completion(const CommandPage& program);
[[nodiscard]] std::string zsh_completion(const CommandPage& program);

}  // namespace mimik::cli
