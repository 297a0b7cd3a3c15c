#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/terminal.h"
#include "facs/facs_catalogue.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

struct Request {
    Common common;
    std::string file;
    bool lint = false, text = false, thesis = false;
};

struct PointCounts {
    std::ptrdiff_t muscle, wrinkle, carried;
};

PointCounts count_points(const facs::ActionUnit& unit) {
    const auto of = [&](facs::ControlKind kind) {
        return std::count_if(unit.points.begin(), unit.points.end(),
                             [&](const auto& point) { return point.kind == kind; });
    };
    return {of(facs::ControlKind::muscle), of(facs::ControlKind::wrinkle), of(facs::ControlKind::carried)};
}

nlohmann::json unit_to_json(const facs::ActionUnit& unit) {
    auto muscles = nlohmann::json::array();
    for (const auto& muscle : unit.muscles)
        muscles.push_back({{"name", muscle.name}, {"source", muscle.source}, {"reference", muscle.reference}});
    const auto counts = count_points(unit);
    return {{"number", unit.number},
            {"name", unit.name},
            {"region", unit.lower_face ? "lower" : "upper"},
            {"sides", unit.central ? "central" : "paired"},
            {"muscles", muscles},
            {"wrinkles", unit.wrinkles},
            {"arkit", unit.arkit},
            {"arkit_whole", unit.arkit_whole},
            {"muscle_points", counts.muscle},
            {"wrinkle_points", counts.wrinkle},
            {"carried_points", counts.carried}};
}

/// Every reference once, with the AUs whose muscles it stands for.
void list_references(const facs::FacsCatalogue& catalogue) {
    std::vector<std::pair<std::string_view, std::vector<int>>> references;
    for (const auto& unit : catalogue.action_units())
        for (const auto& muscle : unit.muscles) {
            auto known = std::find_if(references.begin(), references.end(),
                                      [&](const auto& entry) { return entry.first == muscle.reference; });
            if (known == references.end()) known = references.insert(known, {muscle.reference, {}});
            if (known->second.empty() || known->second.back() != unit.number) known->second.push_back(unit.number);
        }
    std::cout << "\nMuscles after:\n";
    for (const auto& [reference, numbers] : references)
        std::cout << fmt::format("  {} (AU {})\n", reference, fmt::join(numbers, ", "));
}

void list_units(const facs::FacsCatalogue& catalogue, const std::string& name) {
    std::cout << fmt::format("{}: {}; points of one side\n\n", name,
                             base::counted(catalogue.action_units().size(), "action unit"));
    std::cout << fmt::format("{:>3}  {:<22} {:<6} {:<8} {:>6} {:>7} {:>8}  {}\n", "AU", "name", "region", "sides",
                             "muscle", "carried", "wrinkle", "muscles");
    for (const auto& unit : catalogue.action_units()) {
        std::vector<std::string_view> muscles;
        for (const auto& muscle : unit.muscles) muscles.push_back(muscle.name);
        const auto counts = count_points(unit);
        std::cout << fmt::format("{:>3}  {:<22} {:<6} {:<8} {:>6} {:>7} {:>8}  {}\n", unit.number, unit.name,
                                 unit.lower_face ? "lower" : "upper", unit.central ? "central" : "paired",
                                 counts.muscle, counts.carried, counts.wrinkle, fmt::join(muscles, "; "));
    }
    if (!catalogue.all_emotions().empty()) std::cout << '\n';
    for (const auto& emotion : catalogue.all_emotions())
        std::cout << fmt::format("{:<10} {:<8} {}\n", emotion.name, emotion.set, fmt::join(emotion.action_units, "+"));
    list_references(catalogue);
}

int lint(const Request& request, const std::string& text, const std::string& name) {
    const auto findings = facs::lint_catalogue(text);
    const auto errors = std::count_if(findings.begin(), findings.end(), [](const auto& f) { return f.error; });
    if (request.common.json) {
        auto list = nlohmann::json::array();
        for (const auto& finding : findings)
            list.push_back(
                {{"severity", finding.error ? "error" : "warning"}, {"line", finding.line}, {"message", finding.what}});
        std::cout << io::json_text(
            nlohmann::json{{"schema", 1}, {"file", name}, {"errors", errors}, {"findings", list}});
    } else {
        for (const auto& finding : findings)
            std::cout << fmt::format("{}:{}: {}: {}\n", name, finding.line, finding.error ? "error" : "warning",
                                     finding.what);
        std::cout << fmt::format("{}: {}, {}\n", name, base::counted(errors, "error"),
                                 base::counted(static_cast<std::ptrdiff_t>(findings.size()) - errors, "warning"));
    }
    return errors > 0 ? exit_bad_input : exit_done;
}

int run(const Request& request) {
    const bool own = !request.file.empty();
    if (own && request.thesis) throw InputError("--thesis: a file is given, too; give one of them");
    const std::string name = own              ? request.file
                             : request.thesis ? "built-in catalogue of the thesis"
                                              : "built-in catalogue";
    const std::string text =
        own ? base::read_text(request.file, 1 << 22)
            : std::string(request.thesis ? facs::thesis_catalogue_text() : facs::builtin_catalogue_text());
    if (request.text) {
        // To a file as it is; a terminal is spared its control characters.
        (isatty(STDOUT_FILENO) != 0 ? std::cout : raw_output()) << text;
        return exit_done;
    }
    if (request.lint) return lint(request, text, name);
    const auto catalogue = facs::parse_catalogue(text, name);
    if (!request.common.json) {
        list_units(catalogue, name);
        return exit_done;
    }
    auto units = nlohmann::json::array();
    for (const auto& unit : catalogue.action_units()) units.push_back(unit_to_json(unit));
    auto emotions = nlohmann::json::array();
    for (const auto& emotion : catalogue.all_emotions())
        emotions.push_back({{"name", emotion.name}, {"set", emotion.set}, {"units", emotion.action_units}});
    std::cout << io::json_text(
        nlohmann::json{{"schema", 1}, {"catalogue", name}, {"action_units", units}, {"emotions", emotions}});
    return exit_done;
}

}  // namespace

void add_catalogue_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("catalogue", "List the action units of the FACS catalogue, or check another");
    const auto request = std::make_shared<Request>();
    add_common_options(*command, request->common);
    command->add_option("FILE", request->file, "Catalogue file (TOML); without it, the one that Mimik ships");
    auto* lint = command->add_flag("--lint", request->lint, "List every fault of the file with its line");
    command->add_flag("--thesis", request->thesis, "The built-in one with the points of method thesis-tuned");
    command->add_flag("--text", request->text, "Print the file itself: a start for one's own")
        ->excludes(lint, command->get_option("--json"));
    command->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace mimik::cli
