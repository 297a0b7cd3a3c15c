#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace mimik::cli {

/// Numbers are read whole and strictly ("1e", "0x10" and "1,5" are none), and choices name the nearest, with the same
/// words for every command: "--rows is '1e'; give a whole number". For a program and all its commands.
void make_strict(CLI::App& program);

/// What is wrong with a word that is none of an option's choices.
using FaultOfChoice = std::string (*)(const std::string& word, const std::vector<std::string>& choices);
/// Words of its own for one option, whatever the command; before anything is parsed.
void explain_choices(const std::string& option, FaultOfChoice fault);

/// What CLI11 would take otherwise than it is meant: "-.5" is a number.
[[nodiscard]] std::vector<std::string> plain_words(std::vector<std::string> words);

/// The command that the words call: one of the program's, or one of that one's where it has some ("mocap info"), or the
/// program itself where it has none. Null: there are commands, but a word names none of them.
[[nodiscard]] const CLI::App* called_command(const CLI::App& program, const std::vector<std::string>& words);

/// What is wrong with the command's name or the options' names, with the nearest that there is; empty: nothing. Found
/// before anything else, since an option that is mistyped is missing, too.
[[nodiscard]] std::string fault_of_names(const CLI::App& program, const std::vector<std::string>& words);

/// What the parser found, in our words.
[[nodiscard]] std::string fault_of_parser(const CLI::App& program, const std::vector<std::string>& words,
                                          const CLI::ParseError& error);

/// "there is no command 'distnace'; did you mean distance?"
[[nodiscard]] std::string unknown_command(const CLI::App& program, const std::string& word);

/// "mimik animate"
[[nodiscard]] std::string name_of(const CLI::App& command);

}  // namespace mimik::cli
