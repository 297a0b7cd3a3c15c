#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace mimik::cli {

/// Options that every command has.
struct Common {
    bool json = false;   ///< the result as one JSON document on standard output, nothing else there
    bool quiet = false;  ///< no progress, no remarks; errors and the result only
    int threads = 0;     ///< 0 = one per core
};

/// Threads that can work at the same time: what an estimate of time is divided by, however many --threads are asked
/// for.
[[nodiscard]] int working_threads();

/// Adds -V, --version, --json, --quiet, --threads to a command; the thread count is applied before its callback.
void add_common_options(CLI::App& command, Common& common);

/// Which option sets a field of an Options struct.
using OptionOfField = std::map<std::string, std::string>;

/// Runs a check that refuses an option by its field's name ("spacing_mm is 0; ...") and puts before it what was typed:
/// "--spacing: spacing_mm is 0; ...".
void check_by_option(const OptionOfField& options, const std::function<void()>& check);

/// A .bnt is read as a scan, not as a mesh. @throws InputError saying how to get a mesh of one.
void refuse_range_scan(const std::filesystem::path& file);

/// @throws InputError naming the option and the first value that it was given twice.
void refuse_doubles(const std::string& option, const std::vector<std::string>& values);

/// -o, --output of a command that writes a folder. An empty name, as of a shell's variable that is not set, is refused.
CLI::Option* add_output_folder(CLI::App& command, std::string& folder, const std::string& what);

/// Finds out before the work, and in a dry run, that a folder takes no files; a dry run leaves no folder that was not
/// there. @throws InputError as geometry::check_takes_files.
void check_output_folder(const std::filesystem::path& folder, bool dry_run);

/// --seed: a whole number of 0 or more.
void add_seed_option(CLI::App& command, std::uint64_t& seed);

/// Done, done with failures that were listed, bad input, no numerical answer.
enum ExitCode : int { exit_done = 0, exit_done_with_failures = 1, exit_bad_input = 2, exit_no_answer = 3 };

/// Parses and runs the command, prints errors with the program's name before them, and gives what main returns:
/// `exit_code` as the command left it, or the code of the error.
[[nodiscard]] int run(CLI::App& program, int argc, char** argv, const int& exit_code);

/// The words behind the program's name, as they were typed.
[[nodiscard]] const std::vector<std::string>& command_line();

/// What --help prints.
void print_help(const CLI::App& command);

/// Each command lives in a file of its own (<name>_command.cpp) and is listed here and in main.cpp. The function adds
/// the subcommand; when it is chosen, its callback stores what main returns in `exit_code`.
void add_scans_command(CLI::App& app, int& exit_code);
void add_synthesize_command(CLI::App& app, int& exit_code);
void add_panels_command(CLI::App& app, int& exit_code);
void add_preprocess_command(CLI::App& app, int& exit_code);
void add_register_command(CLI::App& app, int& exit_code);
void add_mocap_command(CLI::App& app, int& exit_code);
void add_capture_command(CLI::App& app, int& exit_code);
void add_regions_command(CLI::App& app, int& exit_code);
void add_model_command(CLI::App& app, int& exit_code);
void add_animate_command(CLI::App& app, int& exit_code);
void add_evaluate_command(CLI::App& app, int& exit_code);
void add_run_command(CLI::App& app, int& exit_code);
void add_merge_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_verify_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_tune_command(CLI::App& app, int& exit_code);
void add_sensitivity_command(CLI::App& app, int& exit_code);
void add_additivity_command(CLI::App& app, int& exit_code);
void add_warp_command(CLI::App& app, int& exit_code);
void add_distance_command(CLI::App& app, int& exit_code);
void add_figures_command(CLI::App& app, int& exit_code);
void add_figure_command(CLI::App& app, int& exit_code);
void add_catalogue_command(CLI::App& app, int& exit_code);
void add_help_command(CLI::App& app, int& exit_code);
void add_version_command(CLI::App& app, int& exit_code);

/// A bar with the remaining time on a terminal (standard error), a line now and then otherwise, nothing when quiet or
/// JSON.
class Progress {
public:
    Progress(const Common& common, std::string what, std::size_t total);
    ~Progress();
    void advance(const std::string& label = {});  ///< from any thread

private:
    std::string what_;
    std::size_t total_ = 0, done_ = 0;
    bool shown_ = false, terminal_ = false;
    double begun_s_ = 0, last_shown_s_ = 0;
};

}  // namespace mimik::cli
