#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

// Libraries that take long to load, or read what strangers wrote, are in files of their own beside the program. They
// are looked for when they are needed, and Mimik does without those that were not built.

namespace mimik::base {

/// Where they lie: ../libexec/mimik beside the running program, or what the variable MIMIK_COMPANIONS says.
[[nodiscard]] std::filesystem::path companion_folder();

/// The file of this name there; empty if there is none.
[[nodiscard]] std::filesystem::path find_companion(const std::string& name);

struct CompanionResult {
    std::vector<std::uint8_t> output;
    std::string fault;  ///< empty: none; else what the companion said, or how it ended
};

/// Starts the program, gives it `input` as its standard input and takes its standard output. One that fails says why
/// there and ends with 2. Its standard error is not shown: libraries tell it about every oddity of a file.
/// @param variables  "NAME=value", set for the program alone.
[[nodiscard]] CompanionResult run_companion(const std::filesystem::path& program, std::span<const std::uint8_t> input,
                                            const std::vector<std::string>& variables = {});

}  // namespace mimik::base
