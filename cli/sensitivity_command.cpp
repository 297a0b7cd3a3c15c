#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/model_method.h"
#include "base/csv.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/notes.h"
#include "evaluation/point_sensitivity.h"
#include "io/json_values.h"

namespace mimik::cli {
namespace {

using evaluation::PointSensitivity;
using evaluation::UnitSensitivity;

struct Arguments {
    Common common;
    std::string workspace, catalogue_file, method = "thesis", output;
    std::vector<std::string> action_units = {"1", "2", "4", "12", "14", "15", "17", "20"};
    evaluation::PointSensitivityOptions options;
};

std::vector<int> units_of(const Arguments& arguments, const facs::FacsCatalogue& catalogue) {
    refuse_doubles("--au", arguments.action_units);
    std::vector<int> units;
    for (const auto& text : arguments.action_units) {
        const auto expression = catalogue.expression(text);
        if (expression.units().size() != 1 || expression.units().front().side != facs::Side::both)
            throw InputError(fmt::format(
                "--au: '{}' is not one AU on both sides; points are moved on both at once, such as 12", text));
        units.push_back(expression.units().front().unit);
    }
    return units;
}

std::string csv(const std::vector<UnitSensitivity>& units) {
    std::string text =
        "au,point,kind,cases,error_mm,nothing_mm,step_mm,outward_mm,inward_mm,up_mm,down_mm,largest_mm\n";
    for (const auto& unit : units)
        for (const auto& point : unit.points)
            text +=
                fmt::format("{},{},{},{},{:.6f},{:.6f},{},{},{},{:.6f},{:.6f},{:.6f}\n", unit.unit,
                            base::csv_field(point.name), facs::to_string(point.kind), unit.cases, unit.error_mm,
                            unit.nothing_mm, unit.step_mm, point.midline ? "" : fmt::format("{:.6f}", point.outward_mm),
                            point.midline ? "" : fmt::format("{:.6f}", point.inward_mm), point.up_mm, point.down_mm,
                            point.largest_mm());
    return text;
}

void say(const UnitSensitivity& unit) {
    std::cout << fmt::format(
        "\nAU{}: the source on itself is {:.3f} mm off in the mean of {} (doing nothing {:.3f}). A point moved by {:g} "
        "mm changes that by:\n\n| point | kind | outward | inward | up | down |\n| --- | --- | ---: | ---: | ---: | "
        "---: |\n",
        unit.unit, unit.error_mm, base::counted(unit.cases, "case"), unit.nothing_mm, unit.step_mm);
    auto points = unit.points;
    std::stable_sort(points.begin(), points.end(), [](const PointSensitivity& a, const PointSensitivity& b) {
        return a.largest_mm() > b.largest_mm();
    });
    for (const auto& point : points)
        std::cout << fmt::format("| {} | {} | {} | {} | {:+.4f} | {:+.4f} |\n", point.name, facs::to_string(point.kind),
                                 point.midline ? "" : fmt::format("{:+.4f}", point.outward_mm),
                                 point.midline ? "" : fmt::format("{:+.4f}", point.inward_mm), point.up_mm,
                                 point.down_mm);
}

nlohmann::ordered_json to_json(const UnitSensitivity& unit) {
    auto points = nlohmann::ordered_json::array();
    for (const auto& point : unit.points) {
        nlohmann::ordered_json one{{"name", point.name}, {"kind", facs::to_string(point.kind)}};
        if (!point.midline) {
            one["outward_mm"] = point.outward_mm;
            one["inward_mm"] = point.inward_mm;
        }
        one["up_mm"] = point.up_mm;
        one["down_mm"] = point.down_mm;
        points.push_back(one);
    }
    return {{"au", unit.unit},           {"cases", unit.cases},
            {"error_mm", unit.error_mm}, {"nothing_mm", unit.nothing_mm},
            {"step_mm", unit.step_mm},   {"points", points}};
}

int run(const Arguments& arguments) {
    check_by_option({{"step_mm", "--step"}}, [&] { arguments.options.check(); });
    const auto catalogue =
        arguments.catalogue_file.empty() ? facs::builtin_catalogue() : facs::read_catalogue(arguments.catalogue_file);
    const auto wanted = units_of(arguments, catalogue);
    const auto named = animation::method_by_name(arguments.method);
    const auto* method = dynamic_cast<const animation::ModelMethod*>(named.get());
    if (!method)
        throw InputError(fmt::format("--method: '{}' has no points that could move; take 'thesis'", arguments.method));
    const preprocessing::Workspace workspace(arguments.workspace);
    const evaluation::PerformanceReader reader(workspace);
    const evaluation::TuneGroup group{&reader, workspace.shown_subjects()};
    evaluation::FailureList failures;
    std::vector<UnitSensitivity> units;
    {
        Progress progress(arguments.common, "sensitivity", wanted.size());
        for (const int unit : wanted) {
            try {
                units.push_back(
                    evaluation::point_sensitivity(group, catalogue, unit, *method, arguments.options, failures));
            } catch (const InputError& e) {
                failures.add(e.what());
            }
            progress.advance(fmt::format("AU{}", unit));
        }
    }
    if (units.empty()) throw InputError(fmt::format("no AU was measured ({})", fmt::join(failures.sorted(), "; ")));
    if (!arguments.output.empty()) base::write_atomically(arguments.output, csv(units));
    if (arguments.common.json) {
        auto list = nlohmann::ordered_json::array();
        for (const auto& unit : units) list.push_back(to_json(unit));
        std::cout << io::json_text(nlohmann::ordered_json{
            {"schema", 1}, {"method", arguments.method}, {"units", list}, {"failures", failures.sorted()}});
    } else {
        for (const auto& unit : units) say(unit);
        if (!arguments.output.empty()) std::cout << "\n" << arguments.output << "\n";
    }
    say_failures(failures.sorted());
    return failures.sorted().empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_sensitivity_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("sensitivity", "How much the place of each control point matters to its AU");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command->add_option("--au", arguments->action_units, "AUs whose points are moved, one after another")
        ->delimiter(',')
        ->capture_default_str();
    command->add_option("--method", arguments->method, "Whose points: one that places them on the source")
        ->capture_default_str();
    command->add_option("--catalogue", arguments->catalogue_file,
                        "Another FACS catalogue (TOML) than the built-in one");
    command->add_option("--step", arguments->options.step_mm, "How far each point is moved, mm")->capture_default_str();
    command->add_option("-o,--output", arguments->output, "CSV file to write, beside the tables on the screen");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
