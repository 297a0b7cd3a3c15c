#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/figure_start.h"
#include "cli/notes.h"
#include "cli/subject_names.h"
#include "io/json_values.h"
#include "report/figure_album.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    std::string workspace, output, holes = "fill";
    std::vector<std::string> names;
    report::NamedFigureOptions options;
    bool list = false, keep_parts = false;
};

int say_list(const Arguments& arguments) {
    if (arguments.common.json) {
        auto figures = nlohmann::json::array(), left_out = nlohmann::json::array();
        for (const auto& figure : report::named_figures())
            figures.push_back({{"name", figure.name}, {"title", figure.title}, {"needs", figure.needs}});
        for (const auto& figure : report::left_out_figures())
            left_out.push_back({{"name", figure.name}, {"reason", figure.reason}});
        std::cout << io::json_text(nlohmann::json{{"schema", 1}, {"figures", figures}, {"left_out", left_out}});
        return exit_done;
    }
    for (const auto& figure : report::named_figures())
        std::cout << fmt::format("{:<19} {}; needs {}\n", figure.name, figure.title, figure.needs);
    std::cout << "Left out:\n";
    for (const auto& figure : report::left_out_figures())
        std::cout << fmt::format("  {}: {}\n", figure.name, figure.reason);
    return exit_done;
}

/// Those that are named, each once; else all that can be made of what was given.
std::vector<const report::NamedFigure*> chosen(const Arguments& arguments) {
    std::vector<const report::NamedFigure*> figures;
    for (const auto& name : arguments.names) {
        const auto* figure = &report::named_figure(name);
        for (const auto* other : figures)
            if (other == figure) throw InputError(fmt::format("figure {} is named twice", figure->name));
        figures.push_back(figure);
    }
    if (!figures.empty()) return figures;
    for (const auto& figure : report::named_figures())
        if (figure.kind != report::FigureNeeds::rows || !arguments.options.rows_file.empty())
            figures.push_back(&figure);
    return figures;
}

nlohmann::json to_json(const std::vector<report::AlbumEntry>& entries) {
    auto figures = nlohmann::json::array();
    for (const auto& entry : entries) {
        std::vector<std::string> files;
        for (const auto& file : entry.files) files.push_back(file.string());
        if (entry.failure.empty())
            figures.push_back(
                {{"name", entry.name}, {"files", files}, {"caption", entry.caption}, {"remarks", entry.remarks}});
    }
    return figures;
}

int run(Arguments& arguments) {
    if (arguments.list) return say_list(arguments);
    if (arguments.workspace.empty()) throw InputError("WORK is missing; give a folder made by 'mimik preprocess'");
    if (arguments.output.empty()) throw InputError("--output is missing; give a folder for the figures");
    arguments.options.holes = report::parse_hole_drawing(arguments.holes);
    const auto figures = chosen(arguments);
    const preprocessing::Workspace workspace(arguments.workspace);
    for (auto* subject : {&arguments.options.source, &arguments.options.female, &arguments.options.male})
        if (!subject->empty()) *subject = subject_named(workspace, *subject);
    std::unique_ptr<report::FigureCast> cast;
    check_by_option({{"method", "--method"}, {"error_scale_mm", "--error-scale-mm"}}, [&] {
        cast = std::make_unique<report::FigureCast>(workspace, facs::builtin_catalogue(), arguments.options);
    });
    Progress progress(arguments.common, "figures", figures.size());
    report::AlbumTools tools{.draw = draw_figure, .progress = [&](const std::string& name) { progress.advance(name); }};
    if (!find_svg_program().empty()) tools.convert = convert_svg;
    const auto entries = report::make_album(*cast, figures, arguments.output, tools, arguments.keep_parts);

    std::vector<std::string> failures, notes = cast->remarks();
    std::size_t made = 0;
    for (const auto& entry : entries) {
        if (entry.failure.empty())
            ++made;
        else
            failures.push_back(fmt::format("{}: {}", entry.name, entry.failure));
        for (const auto& remark : entry.remarks) notes.push_back(fmt::format("{}: {}", entry.name, remark));
    }
    if (arguments.common.json)
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"source", cast->source()},
                                                  {"female", cast->female()},
                                                  {"male", cast->male()},
                                                  {"figures", to_json(entries)},
                                                  {"failures", failures}});
    else
        std::cout << fmt::format("{} of {} in {}\n", made, base::counted(entries.size(), "figure"),
                                 (std::filesystem::path(arguments.output) / "index.html").string());
    if (!arguments.common.quiet && !arguments.common.json) say_notes(notes);
    say_failures(failures);
    return failures.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_figures_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("figures", "Make the figures and tables of the thesis, by name");
    auto arguments = std::make_shared<Arguments>();
    auto& options = arguments->options;
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'");
    command->add_option("NAME", arguments->names, "Figures, such as 6-4, A-1, table-3-2; without: all");
    command->add_flag("--list", arguments->list, "Names, what each shows and needs, what is left out and why; stop");
    add_output_folder(*command, arguments->output, "Folder for the figures, captions.md and index.html");
    command->add_option("--source", options.source,
                        "Subject whose expressions are taken; without: who was scanned with most of them");
    command->add_option("--female", options.female, "Female target; without: the first woman who is not the source");
    command->add_option("--male", options.male, "Male target; without: the first man who is not the source");
    command->add_option("--method", options.method, "A method of one source by control points: default, sparse, thesis")
        ->capture_default_str();
    command->add_option("--holes", arguments->holes, "Of scans: fill (in a paler tone), gap, mark (in green)")
        ->check(CLI::IsMember({"fill", "gap", "mark"}))
        ->capture_default_str();
    command->add_option("--error-scale-mm", options.error_scale_mm, "Upper end of the colours of the heat maps")
        ->capture_default_str();
    command->add_option("--rows", options.rows_file, "rows.csv of 'mimik run', for the plots");
    command->add_flag("--keep-parts", arguments->keep_parts,
                      "Leave meshes and descriptions in parts/, for 'mimik figure --description'");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
