#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/animate.h"
#include "animation/face_export.h"
#include "base/errors.h"
#include "cli/command.h"
#include "cli/method_options.h"
#include "cli/regions_file.h"
#include "cli/subject_names.h"
#include "io/json_values.h"
#include "modeling/region_labels.h"
#include "modeling/source_expression.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    MethodArguments method;
    std::string workspace, source = "mean", target, output, frame = "scanner", combine = "sum";
    std::vector<std::string> action_units, model_files, hold;
    std::string regions;
    bool keep_bridged = false, arkit_names = false;
};

/// A model of a file, as good as one measured now: nobody who must not be shown is in it, and what was made otherwise
/// is said.
modeling::ExpressionModel read_model(const preprocessing::Workspace& workspace, const std::string& file,
                                     const std::string& target, const modeling::ModelProvenance& here,
                                     std::vector<std::string>& remarks) {
    auto model = modeling::read_expression_model(file);
    if (model.provenance)
        if (const auto other = modeling::differences(*model.provenance, here); !other.empty())
            remarks.push_back(fmt::format("{}: made otherwise than this animation: {}", file, fmt::join(other, "; ")));
    for (const auto& scan : model.unusable_scans)
        remarks.push_back(fmt::format("{}: left out of the mean: {}", file, scan));
    bool of_target = false;
    for (const auto& name : model.sources)
        if (const auto scan = database::parse_scan_name(name)) {
            workspace.refuse_hidden(scan->subject);
            of_target = of_target || scan->subject == target;
        }
    if (of_target) remarks.push_back(fmt::format("{}: scans of the target itself are in this model", file));
    return model;
}

/// The file that was named, else the one that 'mimik regions' wrote and somebody may have edited, else as drawn.
modeling::RegionLabels region_labels(const preprocessing::Workspace& workspace, std::filesystem::path file) {
    const auto& average = workspace.average();
    if (file.empty()) {
        file = default_regions_file(workspace);
        if (!std::filesystem::exists(file)) return modeling::label_regions(average.grid, average.landmarks);
    }
    return modeling::read_region_labels(file, average);
}

int run(Arguments& arguments) {
    const preprocessing::Workspace workspace(arguments.workspace);
    const auto catalogue = arguments.method.catalogue();
    for (auto* subject : {&arguments.source, &arguments.target}) {
        *subject = subject_named(workspace, *subject);
        workspace.refuse_hidden(*subject);
    }

    const auto model_options = arguments.method.model_options();
    auto animation_options = arguments.method.animation_options();
    animation_options.combination =
        arguments.combine == "parallel" ? animation::Combination::parallel : animation::Combination::sum;

    const modeling::ExpressionSource source{arguments.source, {arguments.target}};
    if (arguments.action_units.empty() && arguments.model_files.empty())
        throw InputError("there is nothing to animate; give --au, such as 12, or --model, a file of 'mimik model'");
    if (!arguments.action_units.empty()) modeling::check_source(workspace, source, model_options);

    const auto neutral = workspace.face(workspace.neutral(arguments.target));
    const animation::TargetFace target(neutral, model_options.normalisation, arguments.method.thesis());
    std::vector<modeling::ExpressionModel> models;
    std::vector<animation::WeightedExpression> expressions;
    std::vector<animation::NamedMagnitude> names;
    std::vector<std::string> remarks, failures;
    const auto named = [&](const modeling::ExpressionModel& model, double magnitude) {
        return animation::NamedMagnitude{
            arguments.arkit_names ? facs::arkit_name(catalogue, model.expression) : model.expression, magnitude,
            facs::arkit_shape(catalogue, model.expression)};
    };
    for (const auto& text : arguments.action_units) {
        const auto selection = facs::split_magnitude(text);
        models.push_back(modeling::model_from_workspace(workspace, catalogue, selection.code, source, model_options));
        for (const auto& scan : models.back().unusable_scans)
            failures.push_back(fmt::format("{}: left out of the mean: {}", models.back().expression, scan));
        names.push_back(named(models.back(), selection.magnitude));
    }
    const auto here = arguments.method.provenance(catalogue, workspace.average());
    for (const auto& text : arguments.model_files) {
        const auto file = std::filesystem::exists(text) ? facs::Selection{text, 1.0} : facs::split_magnitude(text);
        models.push_back(read_model(workspace, file.code, arguments.target, here, remarks));
        names.push_back(named(models.back(), file.magnitude));
    }
    for (std::size_t k = 0; k < models.size(); ++k) expressions.push_back({&models[k], names[k].magnitude});
    if (!arguments.hold.empty()) {
        const auto& average = workspace.average();
        const auto labels = region_labels(workspace, arguments.regions);
        animation_options.keep = modeling::held_weights(
            labels, average, neutral, modeling::listed_regions(labels, arguments.hold), animation_options.border_mm);
    }
    const auto animated = animation::animate(target, expressions, animation_options);

    animation::ExportOptions export_options;
    export_options.frame =
        arguments.frame == "average" ? animation::OutputFrame::average : animation::OutputFrame::scanner;
    export_options.bridged =
        arguments.keep_bridged ? geometry::BridgedVertices::keep : geometry::BridgedVertices::leave_out;
    const auto extent = arguments.frame == "average" ? animation::field_extent(animated.grid, animated.displacement_mm,
                                                                               target.average_from_scan().linear())
                                                     : animated.extent;
    std::filesystem::path texture = neutral.texture_file;
    remarks.insert(remarks.end(), animated.remarks.begin(), animated.remarks.end());
    if (!texture.empty() && !std::filesystem::exists(texture)) {
        remarks.push_back(fmt::format("texture {} is gone, so the mesh has none", texture.string()));
        texture.clear();
    }
    for (auto& remark :
         animation::write_animated_face(arguments.output, animated, target, names, texture, export_options))
        remarks.push_back(std::move(remark));

    for (const auto& model : models)
        for (const auto& reason : model.left_out) remarks.push_back(fmt::format("{}: {}", model.expression, reason));
    const std::string source_words = arguments.action_units.empty()  ? "model files"
                                     : arguments.model_files.empty() ? arguments.source
                                                                     : arguments.source + " and model files";
    if (arguments.common.json) {
        auto list = nlohmann::json::array();
        for (std::size_t k = 0; k < models.size(); ++k)
            list.push_back({{"expression", names[k].name},
                            {"magnitude", names[k].magnitude},
                            {"sources", models[k].sources},
                            {"points", models[k].points.size()},
                            {"largest_displacement_mm", models[k].largest_displacement_mm()}});
        nlohmann::json document = {{"schema", 1},
                                   {"target", neutral.id.name()},
                                   {"source", source_words},
                                   {"method", arguments.method.name},
                                   {"frame", arguments.frame},
                                   {"units", "mm"},
                                   {"expressions", list},
                                   {"largest_displacement_mm", extent.largest_displacement_mm},
                                   {"largest_neighbour_step_mm", extent.largest_neighbour_step_mm},
                                   {"remarks", remarks},
                                   {"failures", failures},
                                   {"output", arguments.output}};
        if (const auto values = animation::vertex_values_file(arguments.output); !values.empty())
            document["vertex_values"] = values.string();
        std::cout << io::json_text(document);
    } else {
        if (!arguments.common.quiet)
            for (const auto& remark : remarks) std::cerr << "note: " << remark << '\n';
        std::vector<std::string> asked = arguments.action_units;
        asked.insert(asked.end(), arguments.model_files.begin(), arguments.model_files.end());
        std::cout << fmt::format("{}: {} from {} on {}, up to {:.1f} mm\n", arguments.output, fmt::join(asked, " + "),
                                 source_words, neutral.id.name(), extent.largest_displacement_mm);
    }
    for (const auto& failure : failures) std::cerr << failure << '\n';
    return failures.empty() ? exit_done : exit_done_with_failures;
}

}  // namespace

void add_animate_command(CLI::App& app, int& exit_code) {
    auto* command =
        app.add_subcommand("animate", "Put expressions of one subject, or of the mean of all, on a neutral face");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command
        ->add_option("--source", arguments->source,
                     "Subject whose expression is taken, or mean (of all but the target)")
        ->capture_default_str();
    command->add_option("--target", arguments->target, "Subject whose first neutral face is animated")->required();
    command
        ->add_option("--au", arguments->action_units,
                     "AU or emotion, side and magnitude: 12, 12:0.5, AU4_L, HAPPY:0.8; repeat or 4,12")
        ->delimiter(',');
    command->add_option("--model", arguments->model_files,
                        "Expression file of 'mimik model', FILE or FILE:magnitude; repeat");
    command->add_option("--combine", arguments->combine, "Several AUs: sum, or parallel (equal pulls do not double)")
        ->check(CLI::IsMember({"sum", "parallel"}))
        ->capture_default_str();
    auto* hold = command->add_option("--hold", arguments->hold,
                                     "Regions that stay still, e.g. nose,eye_left (see 'mimik regions'); repeat");
    command
        ->add_option(
            "--regions", arguments->regions,
            "Label file for --hold (default: average/regions.csv in the workspace if it is there, else as drawn)")
        ->check(CLI::ExistingFile)
        ->needs(hold);
    command->add_option("--frame", arguments->frame, "Millimetres of the target's own scan, or of the average face")
        ->check(CLI::IsMember({"scanner", "average"}))
        ->capture_default_str();
    command->add_flag("--keep-bridged", arguments->keep_bridged,
                      "Keep surface over holes (origin 2: PLY and VTP attribute, _ORIGIN in GLB, OBJ's CSV)");
    command->add_flag("--arkit-names", arguments->arkit_names,
                      "Name the morph targets of a GLB as ARKit does, where it has a name");
    command
        ->add_option("-o,--output", arguments->output,
                     ".ply, .obj, .vtp or .glb; of an .obj the values per vertex in <stem>_vertices.csv")
        ->required();
    arguments->method.add_to(*command);
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
