#pragma once

#include <CLI/CLI.hpp>

namespace mimik::cli {

/// Expression mapping: as the commands of command.h.
void add_examples_command(CLI::App& app, int& exit_code);
void add_perform_command(CLI::App& app, int& exit_code);
void add_live_command(CLI::App& app, int& exit_code);

}  // namespace mimik::cli
