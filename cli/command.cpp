#include "cli/command.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "base/text.h"
#include "cli/error_report.h"
#include "cli/help_pages.h"
#include "cli/option_faults.h"
#include "cli/terminal.h"

namespace mimik::cli {
namespace {
std::mutex progress_mutex;
double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
}  // namespace

int working_threads() {
    const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    return std::clamp(base::thread_count(), 1, cores);
}

void add_common_options(CLI::App& command, Common& common) {
    command.set_version_flag("-V,--version", MIMIK_VERSION, "Print the version and stop");
    command.add_flag("--json", common.json, "Print the result as one JSON document, an error too");
    command.add_flag("--quiet", common.quiet, "No progress and no remarks");
    command.add_option("--threads", common.threads, "Threads to use; 0 = one per core")->capture_default_str();
    command.parse_complete_callback([&common] {
        constexpr int most = 1024;
        if (common.threads < 0 || common.threads > most)
            throw InputError(fmt::format("--threads is {}; give 0 to {}", common.threads, most));
        base::set_thread_count(common.threads);
    });
}

void check_by_option(const OptionOfField& options, const std::function<void()>& check) {
    try {
        check();
    } catch (const InputError& e) {
        const std::string message = e.what();
        const auto it = options.find(message.substr(0, message.find(' ')));
        if (it == options.end()) throw;
        throw InputError(fmt::format("{}: {}", it->second, message));
    }
}

void refuse_range_scan(const std::filesystem::path& file) {
    if (base::equal_ignoring_case(file.extension().string(), ".bnt"))
        throw InputError(
            fmt::format("{}: is a range scan, not a mesh; 'mimik preprocess DB -o WORK' makes one of it: "
                        "WORK/faces/SUBJECT/{}.ply",
                        file.string(), file.stem().string()));
}

void refuse_doubles(const std::string& option, const std::vector<std::string>& values) {
    std::set<std::string> seen;
    for (const auto& value : values)
        if (!seen.insert(value).second)
            throw InputError(fmt::format("{}: '{}' is asked for twice; give it once", option, value));
}

CLI::Option* add_output_folder(CLI::App& command, std::string& folder, const std::string& what) {
    return command.add_option("-o,--output", folder, what)
        ->check(CLI::Validator([](const std::string& text) { return text.empty() ? "is empty; give a folder" : ""; },
                               "", "folder"));
}

void check_output_folder(const std::filesystem::path& folder, bool dry_run) {
    if (!dry_run) return base::check_takes_files(folder);
    // Only making it tells for sure: rights, full disks, links and names too long all come in.
    struct Missing {
        std::vector<std::filesystem::path> folders;  // the innermost first
        ~Missing() {
            std::error_code ignored;
            for (const auto& made : folders) std::filesystem::remove(made, ignored);  // nothing that is not empty
        }
    } missing;
    std::error_code ignored;
    for (auto place = folder; !place.empty() && !exists(symlink_status(place, ignored)); place = place.parent_path())
        missing.folders.push_back(place);
    base::check_takes_files(folder);
}

void add_seed_option(CLI::App& command, std::uint64_t& seed) {
    command.add_option("--seed", seed, "Same seed, same result")->capture_default_str();
}

namespace {

std::vector<std::string> words_of_command_line;

/// The message, on standard error and, with --json, as the one document on standard output.
int report(const CLI::App& program, const std::string& message, int code) {
    const auto& words = words_of_command_line;
    if (asks_for_json(words)) std::cout << error_json(message, code, words) << std::flush;
    say_error(program.get_name(), message);
    return code;
}

/// A result that nobody gets is none: on a full disk the streams fail in silence.
int after_output(const CLI::App& program, int code) {
    std::cout.flush();
    if (std::cout && raw_output().flush()) return code;
    // Who reads a few lines and goes, as `head` does, knows it.
    if (!output_reader_has_ended())
        say_error(program.get_name(), "standard output takes no more (disk full, or closed); nothing can be said");
    return exit_bad_input;
}

void parse(CLI::App& program, const std::vector<std::string>& typed) {
    make_strict(program);
    auto words = plain_words(typed);
    if (const auto fault = fault_of_names(program, words); !fault.empty()) throw InputError(fault);
    try {
        program.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them off the end
    } catch (const CLI::CallForHelp&) {
        const auto* called = called_command(program, words);
        print_help(called ? *called : program);
    } catch (const CLI::CallForVersion&) {
        std::cout << MIMIK_VERSION << '\n';
    } catch (const CLI::ParseError& e) {
        throw InputError(fault_of_parser(program, words, e));
    }
}

}  // namespace

const std::vector<std::string>& command_line() { return words_of_command_line; }

void print_help(const CLI::App& command) {
    // Our own text alone, and our own control codes.
    raw_output() << help_text(page_of(command, name_of(command)), shows_colours(STDOUT_FILENO));
}

int run(CLI::App& program, int argc, char** argv, const int& exit_code) {
    words_of_command_line.assign(argv + std::min(argc, 1), argv + argc);
    try {
        parse(program, words_of_command_line);
        return after_output(program, exit_code);
    } catch (const NumericalError& e) {
        return report(program, e.what(), exit_no_answer);
    } catch (const std::bad_alloc&) {
        return report(program, "there is not enough memory for this input; give a smaller one", exit_bad_input);
    } catch (const std::exception& e) {  // InputError; or the system refused a file, a thread
        return report(program, e.what(), exit_bad_input);
    }
}

namespace {

/// "0:42", "1:05:00"
std::string clock(double seconds) {
    const auto whole = static_cast<long>(seconds + 0.5);
    constexpr long minute = 60, hour = 3600;
    if (whole < hour) return fmt::format("{}:{:02}", whole / minute, whole % minute);
    return fmt::format("{}:{:02}:{:02}", whole / hour, whole % hour / minute, whole % minute);
}

}  // namespace

Progress::Progress(const Common& common, std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      shown_(!common.quiet && !common.json),
      terminal_(isatty(STDERR_FILENO) != 0),
      begun_s_(now_s()) {}

void Progress::advance(const std::string& label) {
    const std::scoped_lock lock(progress_mutex);
    ++done_;
    if (!shown_) return;
    // A terminal is redrawn ten times a second; a log gets a line every ten seconds.
    const double now = now_s();
    if (done_ != total_ && now - last_shown_s_ < (terminal_ ? 0.1 : 10.0)) return;
    last_shown_s_ = now;
    const auto shown = one_line(label);
    if (terminal_) {
        const std::size_t width = 30, filled = total_ ? std::min(width, width * done_ / total_) : width;
        const auto left = static_cast<double>(total_ - std::min(done_, total_));
        const auto remaining = (now - begun_s_) / static_cast<double>(done_) * left;
        raw_error() << fmt::format("\r{} [{}{}] {}/{} {} left {:<24.24}", what_, std::string(filled, '#'),
                                   std::string(width - filled, ' '), done_, total_, clock(remaining), shown)
                    << std::flush;
    } else {
        std::cerr << fmt::format("{}: {}/{} {}\n", what_, done_, total_, shown);
    }
}

Progress::~Progress() {
    if (shown_ && terminal_ && done_ > 0) raw_error() << std::endl;
}

}  // namespace mimik::cli
