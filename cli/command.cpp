#include "cli/command.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "base/text.h"

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
    command.set_version_flag("--version", MIMIK_VERSION);
    command.add_flag("--json", common.json, "Print the result as one JSON document");
    command.add_flag("--quiet", common.quiet, "No progress and no remarks");
    command.add_option("--threads", common.threads, "Threads to use; 0 = one per core")->check(CLI::Range(0, 1024));
    command.parse_complete_callback([&common] { base::set_thread_count(common.threads); });
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
    command.add_option("--seed", seed, "Same seed, same result")
        ->check(CLI::Validator(
            [](const std::string& text) {
                // Read as a number without a sign, -1 would be the largest there is.
                return text.starts_with('-') ? fmt::format("the seed is {}; give a whole number of 0 or more", text)
                                             : std::string();
            },
            "", "seed"))
        ->capture_default_str();
}

int run(CLI::App& app, int argc, char** argv, const int& exit_code) {
    const auto report = [&](const std::exception& e, int code) {
        std::cerr << app.get_name() << ": " << e.what() << '\n';
        return code;
    };
    // A result that nobody gets is none: on a full disk the streams fail in silence.
    const auto after_output = [&](int code) {
        std::cout.flush();
        if (std::cout) return code;
        std::cerr << app.get_name() << ": standard output takes no more (disk full, or closed); nothing can be said\n";
        return static_cast<int>(exit_bad_input);
    };
    try {
        app.parse(argc, argv);
        return after_output(exit_code);
    } catch (const CLI::ParseError& e) {
        return after_output(app.exit(e) == 0 ? exit_done : exit_bad_input);
    } catch (const NumericalError& e) {
        return report(e, exit_no_answer);
    } catch (const std::exception& e) {  // InputError; or the system refused a file, memory, a thread
        return report(e, exit_bad_input);
    }
}

Progress::Progress(const Common& common, std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      shown_(!common.quiet && !common.json),
      terminal_(isatty(STDERR_FILENO) != 0) {}

void Progress::advance(const std::string& label) {
    const std::scoped_lock lock(progress_mutex);
    ++done_;
    if (!shown_) return;
    // A terminal is redrawn ten times a second; a log gets a line every ten seconds.
    const double now = now_s();
    if (done_ != total_ && now - last_shown_s_ < (terminal_ ? 0.1 : 10.0)) return;
    last_shown_s_ = now;
    if (terminal_) {
        const std::size_t width = 30, filled = total_ ? width * done_ / total_ : width;
        std::cerr << fmt::format("\r{} [{}{}] {}/{} {:<24.24}", what_, std::string(filled, '#'),
                                 std::string(width - filled, ' '), done_, total_, label)
                  << std::flush;
    } else {
        std::cerr << fmt::format("{}: {}/{} {}\n", what_, done_, total_, label);
    }
}

Progress::~Progress() {
    if (shown_ && terminal_ && done_ > 0) std::cerr << '\n';
}

}  // namespace mimik::cli
