#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/utsname.h>

#include "base/companion.h"
#include "base/optimiser_modules.h"
#include "base/parallel.h"
#include "base/pcl_module.h"
#include "base/window_module.h"
#include "cli/command.h"
#include "cli/figure_start.h"
#include "cli/libraries.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

std::string system_name() {
    utsname name{};
    if (::uname(&name) != 0) return "unknown";
    return fmt::format("{} {} {}", name.sysname, name.release, name.machine);
}

/// What a report of a fault should say of the program.
nlohmann::ordered_json facts() {
    nlohmann::ordered_json document = {{"schema", 1},
                                       {"mimik", MIMIK_VERSION},
                                       {"commit", commit()},
                                       {"compiler", MIMIK_COMPILER},
                                       {"build_type", MIMIK_BUILD_TYPE},
                                       {"executor", MIMIK_EXECUTOR_NAME},
                                       {"threads", base::thread_count()},
                                       {"system", system_name()},
                                       {"drawing_program", nullptr}};
    try {
        document["drawing_program"] = find_figure_program().string();
    } catch (const std::exception&) {  // there is none, and that is said
    }
    const auto video = find_own_program("mimik-video");
    document["video_program"] =
        video.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(video.string());
    for (const auto& [key, name] :
         {std::pair{"pcl_module", base::pcl_module_name}, std::pair{"opencv_program", "mimik-opencv"},
          std::pair{"ceres_module", base::ceres_module_name}, std::pair{"simplex_module", base::simplex_module_name},
          std::pair{"window_module", base::window_module_name}}) {
        const auto file = base::find_companion(name);
        document[key] = file.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(file.string());
    }
    auto& list = document["libraries"] = nlohmann::ordered_json::object();
    for (const auto& [name, version] : libraries()) list[name] = version;
    return document;
}

}  // namespace

void add_version_command(CLI::App& app, int& exit_code) {
    const auto common = std::make_shared<Common>();
    auto* command = app.add_subcommand("version", "Say of what this program was built, for reports of faults");
    add_common_options(*command, *common);
    command->callback([common, &exit_code] {
        exit_code = exit_done;
        const auto document = facts();
        if (common->json) {
            std::cout << io::json_text(document);
            return;
        }
        for (const auto& [key, value] : document.items())
            if (value.is_string()) std::cout << fmt::format("{:<16} {}\n", key, value.get<std::string>());
        for (const auto& [name, version] : document["libraries"].items())
            std::cout << fmt::format("  {:<14} {}\n", name, version.get<std::string>());
    });
}

}  // namespace mimik::cli
