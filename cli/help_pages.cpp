#include "cli/help_pages.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"

namespace mimik::cli {
namespace {

constexpr std::size_t page_width = 100, widest_name = 26;

/// CLI11 writes the choices of an option into its type: "TEXT:{sum,parallel}".
std::vector<std::string> choices_of(const std::string& type) {
    const auto begin = type.find('{'), end = type.rfind('}');
    std::vector<std::string> choices;
    if (begin == std::string::npos || end == std::string::npos) return choices;
    std::string_view rest = std::string_view(type).substr(begin + 1, end - begin - 1);
    while (!rest.empty()) {
        const auto comma = std::min(rest.find(','), rest.size());
        choices.emplace_back(rest.substr(0, comma));
        rest.remove_prefix(std::min(rest.size(), comma + 1));
    }
    return choices;
}

std::string value_word(const CLI::Option& option, const std::vector<std::string>& choices) {
    if (option.get_items_expected_max() == 0) return {};  // a flag
    constexpr std::size_t most_shown = 8;
    if (choices.size() > most_shown) return "NAME";
    if (!choices.empty()) return fmt::format("{}", fmt::join(choices, "|"));
    const auto type = option.get_type_name();
    auto word = type.starts_with("FLOAT") ? "X" : type.starts_with("INT") || type.starts_with("UINT") ? "N" : "TEXT";
    return option.get_items_expected_min() > 1 ? fmt::format("{0} {0}", word) : word;
}

/// The text in lines that are not longer than the page, each but the first behind `indent` blanks.
std::string wrapped(std::string_view text, std::size_t column, std::size_t indent) {
    std::string lines;
    while (true) {
        const auto word = base::next_word(text);
        if (word.empty()) return lines;
        if (column > indent && column + 1 + word.size() > page_width) {
            lines += '\n' + std::string(indent, ' ');
            column = indent;
        } else if (column > indent) {
            lines += ' ';
            ++column;
        }
        lines += word;
        column += word.size();
    }
}

std::string names_of(const OptionPage& option) {
    auto text = fmt::format("{}", fmt::join(option.names, ", "));
    if (option.is_argument()) return text + (option.repeats ? "..." : "");
    if (!option.value.empty()) text += " " + option.value;
    return text;
}

std::string words_of(const OptionPage& option) {
    auto text = option.help;
    if (!option.fallback.empty()) text += fmt::format(" [{}]", option.fallback);
    if (option.required && !option.is_argument()) text += " (required)";
    return text;
}

std::string listed(const std::string& name, const std::string& words) {
    std::string line = "  " + name;
    if (name.size() <= widest_name)
        line += std::string(widest_name + 2 - name.size(), ' ');
    else
        line += '\n' + std::string(widest_name + 4, ' ');
    return line + wrapped(words, widest_name + 4, widest_name + 4) + '\n';
}

std::vector<std::string> groups_of(const std::vector<OptionPage>& options) {
    std::vector<std::string> groups;
    for (const auto& option : options)
        if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) groups.push_back(option.group);
    return groups;
}

}  // namespace

OptionPage page_of(const CLI::Option& option) {
    OptionPage page;
    if (option.get_positional() && option.get_lnames().empty() && option.get_snames().empty())
        page.names = {option.get_name(true, false)};
    for (const auto& name : option.get_snames()) page.names.push_back("-" + name);
    for (const auto& name : option.get_lnames()) page.names.push_back("--" + name);
    page.choices = choices_of(option.get_type_name());
    page.value = value_word(option, page.choices);
    page.help = option.get_description();
    page.fallback = option.get_default_str();
    if (page.fallback.starts_with('[') && page.fallback.ends_with(']'))
        page.fallback = page.fallback.substr(1, page.fallback.size() - 2);
    page.group = option.get_group();
    page.required = option.get_required();
    page.repeats = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
    return page;
}

CommandPage page_of(const CLI::App& command, const std::string& name) {
    CommandPage page;
    page.name = name;
    page.description = command.get_description();
    page.footer = command.get_footer();
    for (const auto* option : command.get_options({})) {
        if (option->get_group().empty()) continue;  // hidden
        auto one = page_of(*option);
        (one.is_argument() ? page.arguments : page.options).push_back(std::move(one));
    }
    for (const auto* sub : command.get_subcommands({}))
        if (!sub->get_group().empty()) page.commands.push_back(page_of(*sub, name + " " + sub->get_name()));
    return page;
}

std::string usage(const CommandPage& page) {
    std::string text = page.name;
    if (!page.commands.empty()) text += " COMMAND";
    for (const auto& argument : page.arguments)
        text += argument.required ? " " + names_of(argument) : fmt::format(" [{}]", names_of(argument));
    for (const auto& option : page.options)
        if (option.required) text += fmt::format(" {} {}", option.names.front(), option.value);
    return text + " [OPTIONS]";
}

std::string help_text(const CommandPage& page, bool colours) {
    const auto heading = [&](const std::string& text) {
        return colours ? fmt::format("\n\033[1m{}:\033[0m\n", text) : fmt::format("\n{}:\n", text);
    };
    auto text = wrapped(page.description, 0, 0) + '\n' + fmt::format("Usage: {}\n", wrapped(usage(page), 7, 7));
    if (!page.commands.empty()) text += heading("Commands, in the order of work");
    for (const auto& command : page.commands) {
        const auto name = command.name.substr(page.name.size() + 1);
        text += fmt::format("  {:<12} {}\n", name, command.description);
    }
    if (!page.arguments.empty()) text += heading("Arguments");
    for (const auto& argument : page.arguments) text += listed(names_of(argument), words_of(argument));
    for (const auto& group : groups_of(page.options)) {
        text += heading(group);
        for (const auto& option : page.options)
            if (option.group == group) text += listed(names_of(option), words_of(option));
    }
    if (!page.footer.empty()) text += '\n' + wrapped(page.footer, 0, 0) + '\n';
    return text;
}

}  // namespace mimik::cli
