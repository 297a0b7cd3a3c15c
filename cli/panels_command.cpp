#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/expression_names.h"
#include "cli/figure_start.h"
#include "cli/method_options.h"
#include "cli/notes.h"
#include "cli/subject_names.h"
#include "io/json_values.h"
#include "report/comparison_panels.h"

namespace mimik::cli {
namespace {

using report::ComparisonFigure;
using report::ComparisonRequest;

struct Arguments {
    Common common;
    MethodArguments method;
    std::string workspace, output;
    ComparisonRequest request;
    std::vector<std::string> action_units;
    std::vector<double> series;
    std::string holes = "fill";
    bool dry_run = false;
};

struct Planned {
    ComparisonRequest request;
    std::string name;  ///< of the picture and of the folder with its files
};

// What a panel costs on one core and on disk, measured on 150 x 150 vertices (AMD EPYC at 2.6 GHz).
constexpr double seconds_per_panel = 0.15, megabytes_per_panel = 0.9;

/// What a dry run says of one picture: two people have at most five panels each.
double panels_of(const Arguments& arguments, const Planned& planned) {
    if (!arguments.series.empty())
        return static_cast<double>(arguments.series.size()) * static_cast<double>(arguments.action_units.size());
    if (planned.request.source == planned.request.target) return 5;
    return planned.request.source == "mean" ? 7 : 10;
}

/// A picture per AU; a series is one picture of all AUs.
std::vector<Planned> plan(const Arguments& arguments, const preprocessing::Workspace& workspace,
                          const facs::FacsCatalogue& catalogue, std::vector<facs::Expression>& expressions) {
    std::vector<Planned> planned;
    for (const auto& text : arguments.action_units) {
        const auto typed = facs::split_magnitude(text);
        if (!arguments.series.empty() && typed.magnitude != 1.0)
            throw InputError(
                fmt::format("--au {}: the magnitudes of a series stand in --series; give the AU alone", text));
        auto request = arguments.request;
        request.expression = expression_named(workspace, catalogue, typed.text);
        request.method_name = arguments.method.name;
        if (arguments.method.has_control_points()) {
            request.model = arguments.method.model_options();
            request.animation = arguments.method.animation_options();
        }
        request.magnitude = typed.magnitude;
        (void)report::compared_scans(workspace, catalogue, request);  // found out before any work
        expressions.push_back(request.expression);
        const auto name = report::comparison_name(request);
        for (const auto& other : planned)
            if (other.name == name)
                throw InputError(fmt::format("--au {}: picture {} is asked for twice; give each AU once", text, name));
        planned.push_back({request, name});
    }
    if (arguments.series.empty()) return planned;
    report::check_series(workspace, catalogue, planned.front().request, expressions, arguments.series);
    return {{planned.front().request, report::series_name(planned.front().request, expressions)}};
}

nlohmann::json to_json(const Planned& planned, const std::vector<facs::Expression>& expressions,
                       const std::filesystem::path& picture, const ComparisonFigure& figure) {
    auto people = nlohmann::json::array();
    std::vector<std::string> codes;
    for (const auto& expression : expressions) codes.push_back(expression.code());
    for (const auto& person : figure.people)
        people.push_back(
            {{"subject", person.subject},
             {"zone_mm", person.zone_mm},
             {"zone_nothing_mm", person.zone_nothing_mm},
             {"explained", person.explained() ? nlohmann::json(*person.explained()) : nlohmann::json()},
             {"face_mm", person.face_mm ? nlohmann::json(*person.face_mm) : nlohmann::json()},
             {"face_nothing_mm", person.face_nothing_mm ? nlohmann::json(*person.face_nothing_mm) : nlohmann::json()},
             {"border_hits", person.border_hits}});
    return {{"picture", picture.string()},
            {"description", figure.description.string()},
            {"panels", figure.panels},
            {"expressions", codes},
            {"source", planned.request.source},
            {"target", planned.request.target},
            {"method", planned.request.method_name},
            {"distances", people},
            {"colour_scale_mm", figure.scale_mm},
            {"remarks", figure.remarks}};
}

int say_plan(const Arguments& arguments, const std::vector<Planned>& planned) {
    auto pictures = nlohmann::json::array();
    double panels = 0;
    for (const auto& one : planned) {
        auto picture = std::filesystem::path(arguments.output) / one.name;
        picture += ".png";
        pictures.push_back({{"picture", picture.string()}});
        panels += panels_of(arguments, one);
        if (!arguments.common.json) std::cout << picture.string() << '\n';
    }
    const double seconds = panels * seconds_per_panel, megabytes = panels * megabytes_per_panel;
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"dry_run", true},
                                                  {"figures", pictures},
                                                  {"seconds", seconds},
                                                  {"megabytes", megabytes},
                                                  {"failures", nlohmann::json::array()}});
    else
        std::cout << fmt::format("{} of {:.0f} panels: about {:.0f} s, {:.0f} MB in {}\n",
                                 base::counted(planned.size(), "picture"), panels, std::max(1.0, seconds),
                                 std::max(1.0, megabytes), arguments.output);
    return exit_done;
}

/// What was made, and how near the faces come.
void tell(const std::filesystem::path& picture, const ComparisonFigure& figure) {
    std::cout << fmt::format("{}: {}", picture.string(), base::counted(figure.panels, "panel"));
    for (const auto& person : figure.people)
        std::cout << fmt::format("; {} {:.2f} mm from its own scan of it, doing nothing {:.2f} mm", person.subject,
                                 person.zone_mm, person.zone_nothing_mm);
    std::cout << '\n';
}

int run(Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    const auto catalogue = arguments.method.catalogue();
    arguments.request.holes = report::parse_hole_drawing(arguments.holes);
    for (auto* subject : {&arguments.request.source, &arguments.request.target})
        *subject = subject_named(workspace, *subject);
    std::vector<facs::Expression> expressions;
    const auto planned = plan(arguments, workspace, catalogue, expressions);
    const std::filesystem::path folder = arguments.output;
    check_output_folder(folder, arguments.dry_run);
    if (arguments.dry_run) return say_plan(arguments, planned);

    auto figures = nlohmann::json::array();
    std::vector<std::string> failures, notes;
    Progress progress(arguments.common, "panels", planned.size());
    for (const auto& one : planned) {
        auto picture = folder / one.name;
        picture += ".png";
        try {
            const auto figure = arguments.series.empty()
                                    ? write_comparison_panels(workspace, catalogue, one.request, folder / one.name)
                                    : write_magnitude_series(workspace, catalogue, one.request, expressions,
                                                             arguments.series, folder / one.name);
            if (const auto fault = draw_figure(figure.description, picture); !fault.empty())
                failures.push_back(
                    fmt::format("{}; its faces are in {}: draw them with 'mimik figure --description {} -o "
                                "FILE.png'",
                                fault, (folder / one.name).string(), figure.description.string()));
            figures.push_back(to_json(one, arguments.series.empty() ? std::vector{one.request.expression} : expressions,
                                      picture, figure));
            if (!arguments.common.json) tell(picture, figure);
            notes.insert(notes.end(), figure.remarks.begin(), figure.remarks.end());
            failures.insert(failures.end(), figure.failures.begin(), figure.failures.end());
        } catch (const std::exception& e) {
            failures.push_back(fmt::format("{}: {}", one.name, e.what()));  // the others may well be drawn
        }
        progress.advance(one.name);
    }
    if (arguments.common.json)
        std::cout << io::json_text(
            nlohmann::json{{"schema", 1}, {"dry_run", false}, {"figures", figures}, {"failures", failures}});
    if (!arguments.common.quiet && !arguments.common.json) say_notes(notes);
    say_failures(failures);
    return failures.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_panels_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("panels", "Draw neutral, animated and real faces, and their distance in colour");
    auto arguments = std::make_shared<Arguments>();
    auto& request = arguments->request;
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command
        ->add_option("--source", request.source, "Subject whose expression is taken, or mean (of all but the target)")
        ->capture_default_str();
    command->add_option("--target", request.target, "Subject whose first neutral face is animated")->required();
    command
        ->add_option("--au,--expression", arguments->action_units,
                     "AU or emotion, side and magnitude: 12, 12:0.5, 4L, HAPPY; a picture for each, repeat or 4,12")
        ->delimiter(',')
        ->required();
    command
        ->add_option("--series", arguments->series,
                     "Magnitudes, such as 0,0.25,0.5,0.75,1: one picture, a row for each AU")
        ->delimiter(',');
    command->add_option("--view", request.view, "Where the camera stands")
        ->check(CLI::IsMember({"front", "left", "right", "three-quarter-left", "three-quarter-right"}))
        ->capture_default_str();
    command->add_option("--holes", arguments->holes, "Of scans: fill (in a paler tone), gap, mark (in green)")
        ->check(CLI::IsMember({"fill", "gap", "mark"}))
        ->capture_default_str();
    add_output_folder(*command, arguments->output, "Folder for the pictures and the files they are drawn from")
        ->required();
    command->add_flag("--dry-run", arguments->dry_run, "List the pictures, say time and disk, make nothing");
    arguments->method.add_to(*command, MethodArguments::Methods::all);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
