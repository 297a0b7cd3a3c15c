#include "cli/figure_start.h"

#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/errors.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX has it in no header

namespace mimik::cli {
namespace {

constexpr const char* program_name = "mimik-figure";
constexpr const char* video_program_name = "mimik-video";

/// argv of a program; points into `words`.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

bool runs(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

std::filesystem::path beside_this(const std::string& name) {
    std::error_code ignored;
    return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / name;
}

/// A program in one of the folders of PATH; empty: it is in none.
std::filesystem::path on_the_path(const std::string& name) {
    const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    std::string_view folders = path ? path : "";
    while (!folders.empty()) {
        const auto end = folders.find(':');
        const auto folder = folders.substr(0, end);
        folders = end == std::string_view::npos ? std::string_view() : folders.substr(end + 1);
        if (auto file = std::filesystem::path(folder) / name; !folder.empty() && runs(file)) return file;
    }
    return {};
}

}  // namespace

std::string run_program(const std::filesystem::path& program, std::vector<std::string> words) {
    auto arguments = pointers_to(words);
    const auto name = program.filename().string();
    pid_t child = 0;
    const int error = posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ);
    if (error != 0)
        return fmt::format("{} does not start: {}", program.string(), std::system_category().message(error));
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return fmt::format("{} was lost: {}", program.string(), std::system_category().message(errno));
    if (WIFSIGNALED(status)) return fmt::format("{} was ended by signal {}", name, WTERMSIG(status));
    if (WEXITSTATUS(status) != 0) return fmt::format("{} ended with {}", name, WEXITSTATUS(status));
    return {};
}

std::filesystem::path find_own_program(const std::string& name) {
    if (auto file = beside_this(name); runs(file)) return file;
    return on_the_path(name);
}

std::filesystem::path find_figure_program() {
    if (auto file = find_own_program(program_name); !file.empty()) return file;
    throw InputError(
        fmt::format("{} is neither {} nor on the PATH; install it (it is built unless MIMIK_FIGURES is OFF)",
                    program_name, beside_this(program_name).string()));
}

std::filesystem::path find_video_program() {
    if (auto file = find_own_program(video_program_name); !file.empty()) return file;
    throw InputError(fmt::format(
        "{} is neither {} nor on the PATH, so this build reads and writes no video; install libopencv-dev and "
        "opencv-data (scripts/setup.sh --video does), configure and build again",
        video_program_name, beside_this(video_program_name).string()));
}

std::string write_video(const std::filesystem::path& frames, const std::filesystem::path& video, double rate_hz) {
    return run_program(find_video_program(), {video_program_name, "write", frames.string(), video.string(), "--fps",
                                              fmt::format("{:g}", rate_hz), "--quiet"});
}

void become_figure_program(const std::vector<std::string>& arguments) {
    const auto program = find_figure_program();
    std::vector<std::string> words = {program_name};
    words.insert(words.end(), arguments.begin(), arguments.end());
    execv(program.c_str(), pointers_to(words).data());
    throw InputError(fmt::format("{} does not start: {}", program.string(), std::system_category().message(errno)));
}

std::string draw_figure(const std::filesystem::path& description, const std::filesystem::path& picture) {
    std::string fault;
    try {
        // Its errors go to our standard error; there is nothing else that it says when quiet.
        fault = run_program(find_figure_program(),
                            {program_name, "--description", description.string(), "-o", picture.string(), "--quiet"});
    } catch (const InputError& e) {
        fault = e.what();
    }
    if (fault.empty()) return {};
    return fmt::format("{}: not drawn: {}", picture.string(), fault);
}

std::filesystem::path find_svg_program() { return on_the_path("rsvg-convert"); }

std::string convert_svg(const std::filesystem::path& svg, const std::filesystem::path& file) {
    const bool pdf = file.extension() == ".pdf";
    // Plots are laid out for 96 dots an inch; a PDF has no dots.
    std::vector<std::string> words = {"rsvg-convert", "--format", pdf ? "pdf" : "png", "--output", file.string()};
    if (!pdf) words.insert(words.end(), {"--dpi-x", "300", "--dpi-y", "300", "--zoom", "3.125"});
    words.push_back(svg.string());
    const auto fault = run_program(find_svg_program(), words);
    return fault.empty() ? fault : fmt::format("{}: not written: {}", file.string(), fault);
}

}  // namespace mimik::cli
