#include "cli/option_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"
#include "cli/help_pages.h"
#include "cli/nearest.h"
#include "cli/terminal.h"

namespace mimik::cli {
namespace {

std::map<std::string, FaultOfChoice>& faults_of_choices() {
    static std::map<std::string, FaultOfChoice> faults;
    return faults;
}

/// The longest name, which says most.
std::string shown_name(const CLI::Option& option) {
    return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

std::string strict_real(const std::string& option, std::string& text) {
    const auto value = base::parse_double(text);
    if (!value)
        throw InputError(fmt::format("{} is {}; give a number{}", option, base::in_quotes(text),
                                     text.find(',') != std::string::npos ? " with a point, such as 0.5" : ""));
    if (!std::isfinite(*value)) throw InputError(fmt::format("{} is {}; give a finite number", option, text));
    return {};
}

std::string strict_whole(const std::string& option, bool natural, std::string& text) {
    const auto value = base::parse_integer(text);
    const char* wanted = natural ? "a whole number of 0 or more" : "a whole number";
    constexpr auto most = std::numeric_limits<int>::max();
    if (!value) {
        const bool digits = text.find_first_not_of("0123456789", text.starts_with('-') ? 1 : 0) == std::string::npos;
        throw InputError(!text.empty() && text != "-" && digits
                             ? fmt::format("{} is {}; the number is too large", option, base::in_quotes(text))
                             : fmt::format("{} is {}; give {}", option, base::in_quotes(text), wanted));
    }
    if (natural && *value < 0) throw InputError(fmt::format("{} is {}; give {}", option, *value, wanted));
    if (!natural && (*value > most || *value < -most))
        throw InputError(fmt::format("{} is {}; give {} up to {}", option, *value, wanted, most));
    text = std::to_string(*value);  // CLI11 would read "010" as 8
    return {};
}

std::string strict_choice(const std::string& option, const std::vector<std::string>& choices, const std::string& text) {
    if (std::find(choices.begin(), choices.end(), text) != choices.end()) return {};
    if (const auto own = faults_of_choices().find(option); own != faults_of_choices().end())
        throw InputError(own->second(text, choices));
    throw InputError(fmt::format("{} is {}; give one of {}{}", option, base::in_quotes(text), fmt::join(choices, ", "),
                                 did_you_mean(text, choices)));
}

/// A name of a file or folder to be written. What is read may be called as it is.
std::string plain_output(const std::string& option, const std::string& text) {
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
    if (std::any_of(text.begin(), text.end(), is_control))
        throw InputError(fmt::format("{} is '{}'; give a name without line breaks and other control characters", option,
                                     one_line(text)));
    if (text.starts_with('='))  // "-o=face.ply": only long options take a value so
        throw InputError(fmt::format("{} is {}; give it behind a blank: -o {}", option, base::in_quotes(text),
                                     one_line(text.substr(1))));
    return {};
}

/// A check that runs before those which the option has.
void make_strict(CLI::Option& option) {
    const auto type = option.get_type_name();
    const auto name = shown_name(option);
    CLI::Validator check;
    if (name == "--output" || name == "OUT")
        check = CLI::Validator([=](std::string& text) { return plain_output(name, text); }, "");
    else if (const auto choices = page_of(option).choices; !choices.empty())
        check = CLI::Validator([=](std::string& text) { return strict_choice(name, choices, text); }, "");
    else if (option.get_items_expected_max() == 0)
        return;
    else if (type.starts_with("FLOAT"))
        check = CLI::Validator([=](std::string& text) { return strict_real(name, text); }, "");
    else if (type.starts_with("INT") || type.starts_with("UINT"))
        check = CLI::Validator(
            [=, natural = type.starts_with('U')](std::string& text) { return strict_whole(name, natural, text); }, "");
    else
        return;
    option.transform(check);
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const auto* option : command.get_options({}))
        for (auto& name : page_of(*option).names)
            if (name.starts_with('-')) names.push_back(std::move(name));
    return names;
}

/// What the option or argument is, as the help says.
const CLI::Option* option_named(const CLI::App& command, const std::string& name) {
    for (const auto* option : command.get_options({}))
        if (option->check_name(name) || option->get_name() == name || option->get_name(true, false) == name)
            return option;
    return nullptr;
}

bool is_number(std::string_view word) {
    return word.size() > 1 && word[0] == '-' && ((word[1] >= '0' && word[1] <= '9') || word[1] == '.');
}

std::string unknown_option(const CLI::App& command, const std::vector<std::string>& words) {
    for (const auto& word : words) {
        if (word == "--") return {};
        if (word.size() < 2 || word[0] != '-' || is_number(word)) continue;
        const bool is_long = word.starts_with("--");
        const auto name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
        if (command.get_option_no_throw(name)) continue;
        const auto typed = is_long ? name : word;
        auto mend = did_you_mean(is_long ? typed : "-" + typed, option_names(command));
        if (mend.empty()) mend = fmt::format("; '{} --help' lists all", name_of(command));
        return fmt::format("{}: is no option of '{}'{}", typed, name_of(command), mend);
    }
    return {};
}

/// The first word of CLI11's message: the name of the option that it complains about.
std::string name_in(const CLI::ParseError& error) {
    const std::string message = error.what();
    return message.substr(0, message.find_first_of(": "));
}

std::string missing(const CLI::App& command, const CLI::ParseError& error) {
    const auto name = name_in(error);
    if (!command.get_subcommands({}).empty())
        return fmt::format("a command is missing; '{} --help' lists them", name_of(command));
    const auto* option = option_named(command, name);
    const auto shown = option ? shown_name(*option) : name;
    return fmt::format("{}: is missing{}; usage: {}", shown,
                       option ? fmt::format(" ({})", option->get_description()) : std::string(),
                       usage(page_of(command, name_of(command))));
}

std::string too_many(const CLI::App& command, const CLI::ParseError& error) {
    const std::string message = error.what();
    const auto begin = message.find(": ");
    const auto rest = begin == std::string::npos ? message : message.substr(begin + 2);
    return fmt::format("{}: more than '{}' takes; usage: {}", base::in_quotes(rest), name_of(command),
                       usage(page_of(command, name_of(command))));
}

std::string wrong_count(const CLI::App& command, const CLI::ParseError& error) {
    const auto name = name_in(error);
    const auto* option = option_named(command, name);
    const auto shown = option ? shown_name(*option) : name;
    const std::string message = error.what();
    if (message.find("At Most") != std::string::npos)
        return fmt::format("{}: is given {} times; give it once", shown, message.substr(message.rfind(' ') + 1));
    if (option && option->get_items_expected_min() > 1)
        return fmt::format("{}: needs {} values; give all of them", shown, option->get_items_expected_min());
    return fmt::format("{}: its value is missing{}", shown,
                       option ? fmt::format("; give one: {}", option->get_description()) : std::string());
}

}  // namespace

void explain_choices(const std::string& option, FaultOfChoice fault) { faults_of_choices()[option] = fault; }

void make_strict(CLI::App& program) {
    for (auto* option : program.get_options()) make_strict(*option);
    for (auto* command : program.get_subcommands({})) make_strict(*command);
}

std::vector<std::string> plain_words(std::vector<std::string> words) {
    for (auto& word : words)
        if (word.size() > 2 && word.starts_with("-.") && word[2] >= '0' && word[2] <= '9') word.insert(1, "0");
    return words;
}

std::string name_of(const CLI::App& command) {
    return command.get_parent() ? name_of(*command.get_parent()) + " " + command.get_name() : command.get_name();
}

std::string unknown_command(const CLI::App& program, const std::string& word) {
    std::vector<std::string> names;
    for (const auto* command : program.get_subcommands({})) names.push_back(command->get_name());
    return fmt::format("there is no command {}{}; '{} --help' lists all", base::in_quotes(word),
                       did_you_mean(word, names), name_of(program));
}

const CLI::App* called_command(const CLI::App& program, const std::vector<std::string>& words) {
    const auto commands = program.get_subcommands({});
    if (commands.empty() || words.empty() || words[0].starts_with('-')) return &program;
    for (const auto* command : commands)
        if (command->get_name() == words[0]) return called_command(*command, {words.begin() + 1, words.end()});
    return nullptr;
}

std::string fault_of_names(const CLI::App& program, const std::vector<std::string>& words) {
    for (const auto* command : program.get_subcommands({}))
        if (!words.empty() && command->get_name() == words[0])
            return fault_of_names(*command, {words.begin() + 1, words.end()});
    if (!called_command(program, words)) return unknown_command(program, words[0]);
    return unknown_option(program, words);
}

std::string fault_of_parser(const CLI::App& program, const std::vector<std::string>& words,
                            const CLI::ParseError& error) {
    const auto* called = called_command(program, words);
    const auto& command = called ? *called : program;
    if (dynamic_cast<const CLI::RequiredError*>(&error)) return missing(command, error);
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) return too_many(command, error);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return wrong_count(command, error);
    const std::string message = error.what();
    const auto pair = [&](std::string_view verb, std::string_view words_between, std::string_view mend) {
        const auto at = message.find(verb);
        return fmt::format("{} {} {}; {}", message.substr(0, at), words_between, message.substr(at + verb.size()),
                           mend);
    };
    if (dynamic_cast<const CLI::ExcludesError*>(&error)) return pair(" excludes ", "excludes", "give one of them");
    if (dynamic_cast<const CLI::RequiresError*>(&error)) return pair(" requires ", "needs", "give both");
    return message;
}

}  // namespace mimik::cli
