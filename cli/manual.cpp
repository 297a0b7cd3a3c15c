// The manual page and the completions of the shells, of the same pages as the help.
#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/help_pages.h"

namespace mimik::cli {
namespace {

std::string roff(std::string_view text) {
    std::string safe;
    if (text.starts_with('.') || text.starts_with('\'')) safe = "\\&";
    for (const char c : text)
        if (c == '\\')
            safe += "\\e";
        else if (c == '-')
            safe += "\\-";
        else
            safe += c;
    return safe;
}

std::string roff_of(const OptionPage& option) {
    std::string names;
    for (const auto& name : option.names) names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
    if (!option.value.empty() && !option.is_argument()) names += fmt::format(" \\fI{}\\fR", roff(option.value));
    auto text = fmt::format(".TP\n{}\n{}", names, roff(option.help));
    if (!option.fallback.empty()) text += fmt::format(" [{}]", roff(option.fallback));
    if (option.required && !option.is_argument()) text += " (required)";
    return text + '\n';
}

std::string words_of(const std::vector<OptionPage>& options) {
    std::vector<std::string> words;
    for (const auto& option : options) words.insert(words.end(), option.names.begin(), option.names.end());
    return fmt::format("{}", fmt::join(words, " "));
}

std::string short_name(const CommandPage& program, const CommandPage& command) {
    return command.name.substr(program.name.size() + 1);
}

/// A command of the program with what the commands have that it has itself ("mocap info"): each option once.
CommandPage with_its_commands(CommandPage page) {
    const auto has = [&](const OptionPage& option) {
        return std::any_of(page.options.begin(), page.options.end(),
                           [&](const OptionPage& other) { return other.names.back() == option.names.back(); });
    };
    for (const auto& command : page.commands)
        for (const auto& option : command.options)
            if (!has(option)) page.options.push_back(option);
    return page;
}
std::vector<CommandPage> merged_commands(const CommandPage& program) {
    std::vector<CommandPage> commands;
    for (const auto& command : program.commands) commands.push_back(with_its_commands(command));
    return commands;
}

std::string names_of_commands(const CommandPage& program) {
    std::vector<std::string> names;
    for (const auto& command : program.commands) names.push_back(short_name(program, command));
    return fmt::format("{}", fmt::join(names, " "));
}

/// Within single quotes of zsh, and within the brackets of _arguments.
std::string zsh_words(std::string_view text) {
    std::string safe;
    for (const char c : text)
        if (c == '\'')
            safe += "'\\''";
        else if (c == '[' || c == ']' || c == ':' || c == '\\')
            safe += std::string("\\") + c;
        else
            safe += c;
    return safe;
}

std::string zsh_option(const OptionPage& option) {
    std::string lines;
    for (const auto& name : option.names) {
        std::string action;
        if (!option.choices.empty())
            action = fmt::format(":value:({})", fmt::join(option.choices, " "));
        else if (!option.value.empty())
            action = ":value:_files";
        lines += fmt::format("        '*{}[{}]{}' \\\n", name, zsh_words(option.help), action);
    }
    return lines;
}

}  // namespace

std::string manual_page(const CommandPage& program, const std::string& version) {
    auto text = fmt::format(".TH MIMIK 1 \"\" \"mimik {}\" \"User commands\"\n.SH NAME\nmimik \\- {}\n", version,
                            "expressions on 3D face scans, and how true they are");
    text += fmt::format(".SH SYNOPSIS\n.B {}\n.SH DESCRIPTION\n{}\n.SH OPTIONS\n", roff(usage(program)),
                        roff(program.description));
    for (const auto& option : program.options) text += roff_of(option);
    text += ".SH COMMANDS\n";
    const auto add = [&](const CommandPage& command) {
        text += fmt::format(".SS {}\n.B {}\n.PP\n{}\n", roff(short_name(program, command)), roff(usage(command)),
                            roff(command.description));
        for (const auto& argument : command.arguments) text += roff_of(argument);
        for (const auto& option : command.options) text += roff_of(option);
    };
    for (const auto& command : program.commands) {
        add(command);
        for (const auto& its : command.commands) add(its);
    }
    text += fmt::format(".SH EXIT STATUS\n{}\n", roff(program.footer));
    text +=
        ".SH ENVIRONMENT\n.TP\n\\fBNO_COLOR\\fR\nNo colours on a terminal; elsewhere there are none.\n"
        ".TP\n\\fBMIMIK_DRAWING\\fR\nThe one way to draw that is tried: egl, display or xvfb.\n";
    return text;
}

std::string bash_completion(const CommandPage& program) {
    auto text = fmt::format(
        "# bash completion of {0}, made by '{0} help --format bash'\n"
        "_{0}() {{\n"
        "    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words=\n"
        "    COMPREPLY=()\n"
        "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
        "        COMPREPLY=($(compgen -W \"{1} {2}\" -- \"$current\"))\n"
        "        return\n"
        "    fi\n"
        "    case \"${{COMP_WORDS[1]}} $previous\" in\n"
        "    'help help') words=\"{1}\" ;;\n",
        program.name, names_of_commands(program), words_of(program.options));
    const auto commands = merged_commands(program);
    for (const auto& command : commands)
        if (!command.commands.empty())
            text += fmt::format("    '{0} {0}') words=\"{1}\" ;;\n", short_name(program, command),
                                names_of_commands(command));
    for (const auto& command : commands)
        for (const auto& option : command.options)
            if (!option.choices.empty())
                for (const auto& name : option.names)
                    text += fmt::format("    '{} {}') words=\"{}\" ;;\n", short_name(program, command), name,
                                        fmt::join(option.choices, " "));
    text +=
        "    esac\n"
        "    if [ -z \"$words\" ] && [[ $current == -* ]]; then\n"
        "        case \"${COMP_WORDS[1]}\" in\n";
    for (const auto& command : commands)
        text += fmt::format("        {}) words=\"{}\" ;;\n", short_name(program, command), words_of(command.options));
    return text + fmt::format(
                      "        esac\n"
                      "    fi\n"
                      "    [ -z \"$words\" ] || COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
                      "}}\n"
                      "complete -o default -F _{0} {0}  # files where no word fits\n",
                      program.name);
}

std::string zsh_completion(const CommandPage& program) {
    auto text = fmt::format(
        "#compdef {0}\n# zsh completion of {0}, made by '{0} help --format zsh'\n_{0}() {{\n"
        "    local -a commands\n    commands=(\n",
        program.name);
    for (const auto& command : program.commands)
        text += fmt::format("        '{}:{}'\n", short_name(program, command), zsh_words(command.description));
    text +=
        "    )\n    if (( CURRENT == 2 )); then\n        _describe command commands\n        return\n    fi\n"
        "    local command=$words[2]\n    shift words\n    (( CURRENT-- ))\n    case $command in\n";
    for (const auto& command : merged_commands(program)) {
        text += fmt::format("    {})\n        _arguments \\\n", short_name(program, command));
        for (const auto& option : command.options) text += zsh_option(option);
        const auto& of = command.name == program.name + " help" ? program : command;
        if (!of.commands.empty()) text += "        '1:command:(" + names_of_commands(of) + ")'";
        text += of.commands.empty() || &of == &command
                    ? fmt::format("{}        '*:file:_files' ;;\n", of.commands.empty() ? "" : " \\\n")
                    : " ;;\n";
    }
    return text + fmt::format("    esac\n}}\n_{0} \"$@\"\n", program.name);
}

}  // namespace mimik::cli
