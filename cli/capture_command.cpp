#include <cerrno>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.h"
#include "cli/capture_options.h"
#include "cli/command.h"
#include "cli/figure_start.h"
#include "cli/performance_commands.h"

namespace mimik::cli {
namespace {

/// OpenCV is loaded only by those who use it: the other program reads the same words again.
[[noreturn]] void become_video_program(const char* its_command) {
    const auto program = find_video_program();
    std::vector<std::string> words = {"mimik-video", its_command};
    const auto& typed = command_line();
    words.insert(words.end(), typed.begin() + 1, typed.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv(program.c_str(), pointers.data());
    throw InputError(fmt::format("{} does not start: {}", program.string(), std::system_category().message(errno)));
}

}  // namespace

void add_capture_command(CLI::App& app, int& /*exit_code*/) {
    auto* command = app.add_subcommand("capture", "Follow a performer's face in video, without markers");
    const auto arguments = std::make_shared<CaptureArguments>();
    add_capture_options(*command, *arguments);
    command->callback([arguments] {
        check_capture_options(*arguments);
        become_video_program("track");
    });
}

void add_live_command(CLI::App& app, int& /*exit_code*/) {
    auto* command = app.add_subcommand("live", "Let a face move as the performer before a camera does");
    const auto arguments = std::make_shared<LiveArguments>();
    add_live_options(*command, *arguments);
    command->callback([arguments] {
        check_live_options(*arguments);
        become_video_program("live");
    });
}

}  // namespace mimik::cli
