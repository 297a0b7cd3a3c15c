#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

// What is wrong with the names of files that a command was given is said before the work.

namespace mimik::cli {

/// Refuses an empty name, as of a shell's variable that is not set, where leaving the option out has a meaning.
[[nodiscard]] CLI::Validator named_file();

/// @throws InputError if a file that is written has another ending. An empty name is no file.
void check_ending(const char* option, const std::string& file, const char* extension);

struct NamedFile {
    std::string option, file;  ///< an empty name is no file
};
/// Nothing is written over what is read, nor over what else is written. @param read  how many stand first
/// @throws InputError naming both options
void check_files_differ(const std::vector<NamedFile>& files, std::size_t read);

}  // namespace mimik::cli
