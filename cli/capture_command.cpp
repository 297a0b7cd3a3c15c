#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.h"
#include "cli/capture_options.h"
#include "cli/command.h"

namespace mimik::cli {
namespace {

/// Beside this program: OpenCV's video modules are loaded only by those who use them.
std::filesystem::path capture_program() {
    const char* name = "mimik-video";
    std::error_code ignored;
    const auto beside = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / name;
    if (std::filesystem::is_regular_file(beside, ignored)) return beside;
    throw InputError(
        fmt::format("{}: is not there, so this build reads no video; install libopencv-dev and opencv-data "
                    "(scripts/setup.sh does), configure and build again",
                    beside.string()));
}

}  // namespace

void add_capture_command(CLI::App& app, int& /*exit_code*/) {
    auto* command = app.add_subcommand("capture", "Follow a performer's face in video, without markers");
    const auto arguments = std::make_shared<CaptureArguments>();
    add_capture_options(*command, *arguments);
    command->callback([arguments] {
        check_capture_options(*arguments);
        const auto program = capture_program();
        // The other program reads the same words again.
        std::vector<std::string> words = {"mimik-video", "track"};
        const auto& typed = command_line();
        words.insert(words.end(), typed.begin() + 1, typed.end());
        std::vector<char*> pointers;
        pointers.reserve(words.size() + 1);
        for (auto& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        execv(program.c_str(), pointers.data());
        throw InputError(fmt::format("{} does not start: {}", program.string(), std::system_category().message(errno)));
    });
}

}  // namespace mimik::cli
