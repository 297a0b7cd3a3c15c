#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "cli/command.h"
#include "geometry/errors.h"

namespace mimik::cli {
namespace {

/// Becomes `mimik-figure`, which stands beside this program or on the PATH: VTK's libraries are then loaded only by
/// those who draw.
[[noreturn]] void become_figure_program(const std::vector<std::string>& arguments) {
    const std::string name = "mimik-figure";
    std::vector<std::string> words = {name};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);

    std::error_code ignored;
    const auto beside = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / name;
    execv(beside.c_str(), pointers.data());
    execvp(name.c_str(), pointers.data());
    throw InputError(name + " is neither " + beside.string() +
                     " nor on the PATH; install it (it is built unless MIMIK_FIGURES is OFF)");
}

}  // namespace

void add_figure_command(CLI::App& app, int& /*exit_code*/) {
    auto* command = app.add_subcommand("figure", "Draw faces side by side (see 'mimik figure --help')");
    command->set_help_flag();  // the other program answers --help
    command->prefix_command();
    command->callback([command] { become_figure_program(command->remaining()); });
}

}  // namespace mimik::cli
