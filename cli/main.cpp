#include <algorithm>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command.h"

namespace {

/// Letters to put in, leave out or change between two words (Levenshtein 1966).
std::size_t edits_between(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = k;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t k = 0; k < b.size(); ++k) {
            const auto changed = diagonal + (a[i] == b[k] ? 0 : 1);
            diagonal = row[k + 1];
            row[k + 1] = std::min({changed, diagonal + 1, row[k] + 1});
        }
    }
    return row.back();
}

/// What is wrong with the command's name; empty: nothing. The parser says only that it wants a command.
std::string unknown_command(const CLI::App& app, std::string_view word) {
    std::vector<std::pair<std::size_t, std::string>> names;
    for (const auto* command : app.get_subcommands({})) {
        if (command->get_name() == word) return {};
        names.emplace_back(edits_between(word, command->get_name()), command->get_name());
    }
    std::sort(names.begin(), names.end());
    constexpr std::size_t shown = 3;
    std::vector<std::string> nearest;
    for (std::size_t k = 0; k < std::min(shown, names.size()); ++k) nearest.push_back(names[k].second);
    return fmt::format("there is no command '{}'; the nearest are {}; 'mimik --help' lists all", word,
                       fmt::join(nearest, ", "));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Mimik puts expressions on 3D face scans and measures how true they are.", "mimik"};
    app.set_version_flag("--version", MIMIK_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Ends with 0: done; 1: done, with failures that are listed; 2: bad input; 3: the numbers allow no answer.");
    int exit_code = mimik::cli::exit_done;
    mimik::cli::add_scans_command(app, exit_code);
    mimik::cli::add_animate_command(app, exit_code);
    mimik::cli::add_catalogue_command(app, exit_code);
    mimik::cli::add_distance_command(app, exit_code);
    mimik::cli::add_evaluate_command(app, exit_code);
    mimik::cli::add_figure_command(app, exit_code);
    mimik::cli::add_model_command(app, exit_code);
    mimik::cli::add_panels_command(app, exit_code);
    mimik::cli::add_preprocess_command(app, exit_code);
    mimik::cli::add_synthesize_command(app, exit_code);
    mimik::cli::add_regions_command(app, exit_code);
    mimik::cli::add_warp_command(app, exit_code);
    if (argc > 1 && argv[1][0] != '-')
        if (const auto fault = unknown_command(app, argv[1]); !fault.empty()) {
            std::cerr << "mimik: " << fault << '\n';
            return mimik::cli::exit_bad_input;
        }
    return mimik::cli::run(app, argc, argv, exit_code);
}
