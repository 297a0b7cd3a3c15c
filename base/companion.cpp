#include "base/companion.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX has it in no header

namespace mimik::base {
namespace {

/// A file that has no name and is gone when it is closed: unlike a pipe it is never full and never broken.
class NamelessFile {
public:
    NamelessFile() : descriptor_(memfd_create("mimik", MFD_CLOEXEC)) {
        if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "no file in memory");
    }
    ~NamelessFile() { ::close(descriptor_); }
    NamelessFile(const NamelessFile&) = delete;
    NamelessFile& operator=(const NamelessFile&) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    void fill(std::span<const std::uint8_t> bytes) const {
        std::size_t done = 0;
        while (done < bytes.size()) {
            const auto written =
                ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) throw std::system_error(errno, std::generic_category(), "no memory for a file");
            done += static_cast<std::size_t>(written);
        }
    }
    [[nodiscard]] std::vector<std::uint8_t> content() const {
        struct stat state {};
        if (::fstat(descriptor_, &state) != 0) throw std::system_error(errno, std::generic_category());
        std::vector<std::uint8_t> bytes(static_cast<std::size_t>(state.st_size));
        std::size_t done = 0;
        while (done < bytes.size()) {
            const auto got = ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) throw std::system_error(errno, std::generic_category());
            done += static_cast<std::size_t>(got);
        }
        return bytes;
    }

private:
    int descriptor_;
};

/// What went wrong; empty: nothing.
std::string start_and_wait(const std::string& program, const std::vector<std::string>& variables,
                           const NamelessFile& input, const NamelessFile& output) {
    std::vector<std::string> words = {program};
    std::vector<char*> arguments = {words[0].data(), nullptr}, environment;
    auto own = variables;
    for (auto& variable : own) environment.push_back(variable.data());  // of two the first counts
    for (char** variable = environ; *variable != nullptr; ++variable) environment.push_back(*variable);
    environment.push_back(nullptr);
    posix_spawn_file_actions_t streams;
    posix_spawn_file_actions_init(&streams);
    posix_spawn_file_actions_adddup2(&streams, input.descriptor(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&streams, output.descriptor(), STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&streams, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int error = posix_spawn(&child, program.c_str(), &streams, nullptr, arguments.data(), environment.data());
    posix_spawn_file_actions_destroy(&streams);
    if (error != 0) return fmt::format("{} does not start: {}", program, std::generic_category().message(error));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return fmt::format("{} was lost: {}", program, std::generic_category().message(errno));
    if (WIFSIGNALED(status)) return fmt::format("{} was ended by signal {}", program, WTERMSIG(status));
    if (const int code = WEXITSTATUS(status); code != 0 && code != 2)
        return fmt::format("{} ended with {}", program, code);
    return WEXITSTATUS(status) == 0 ? std::string() : std::string(1, '\0');  // its own words
}

}  // namespace

std::filesystem::path companion_folder() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing here sets variables
    if (const char* said = std::getenv("MIMIK_COMPANIONS"); said != nullptr) return said;
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    return program.parent_path().parent_path() / "libexec" / "mimik";
}

std::filesystem::path find_companion(const std::string& name) {
    std::error_code ignored;
    auto file = companion_folder() / name;
    return std::filesystem::is_regular_file(file, ignored) ? file : std::filesystem::path();
}

CompanionResult run_companion(const std::filesystem::path& program, std::span<const std::uint8_t> input,
                              const std::vector<std::string>& variables) {
    const NamelessFile given, taken;
    given.fill(input);
    CompanionResult result;
    result.fault = start_and_wait(program.string(), variables, given, taken);
    auto output = taken.content();
    if (result.fault == std::string(1, '\0'))
        result.fault.assign(output.begin(), output.end());
    else if (result.fault.empty())
        result.output = std::move(output);
    return result;
}

}  // namespace mimik::base
