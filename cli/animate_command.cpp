#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/output_folder.h"
#include "base/text.h"
#include "cli/animate_job.h"
#include "cli/regions_file.h"
#include "cli/subject_names.h"
#include "modeling/region_labels.h"

namespace mimik::cli {
namespace {

/// The file that was named, else the one that 'mimik regions' wrote and somebody may have edited, else as drawn.
modeling::RegionLabels region_labels(const preprocessing::Workspace& workspace, std::filesystem::path file) {
    const auto& average = workspace.average();
    if (file.empty()) {
        file = default_regions_file(workspace);
        if (!std::filesystem::exists(file)) return modeling::label_regions(average.grid, average.landmarks);
    }
    return modeling::read_region_labels(file, average);
}

animation::AnimationOptions animation_options(const AnimateArguments& arguments,
                                              const preprocessing::Workspace& workspace,
                                              const preprocessing::Face& neutral) {
    auto options = arguments.method.animation_options();
    options.combination = combination_of(arguments);
    if (arguments.hold.empty()) return options;
    const auto labels = region_labels(workspace, arguments.regions);
    options.keep = modeling::held_weights(labels, workspace.average(), neutral,
                                          modeling::listed_regions(labels, arguments.hold), options.border_mm);
    return options;
}

/// The scan's image, or a remark that it is gone.
std::filesystem::path texture_of(const preprocessing::Face& neutral, std::vector<std::string>& remarks) {
    if (neutral.texture_file.empty() || std::filesystem::exists(neutral.texture_file)) return neutral.texture_file;
    remarks.push_back(fmt::format("texture {} is gone, so the mesh has none", neutral.texture_file.string()));
    return {};
}

/// A face of the workspace.
int animate_scan(const AnimateArguments& arguments, const ExpressionShelf& shelf, ChosenExpressions& chosen) {
    const auto& workspace = *shelf.workspace();
    const auto neutral = workspace.face(workspace.neutral(arguments.target));
    const animation::PreparedTarget target(neutral);
    const auto animated =
        animation::animate(target, chosen.weighted(), animation_options(arguments, workspace, neutral));
    auto& remarks = chosen.remarks;
    remarks.insert(remarks.end(), animated.remarks.begin(), animated.remarks.end());

    animation::ExportOptions export_options;
    export_options.bridged =
        arguments.keep_bridged ? geometry::BridgedVertices::keep : geometry::BridgedVertices::leave_out;
    auto extent = animated.extent;
    if (arguments.frame == "average") {
        export_options.average_from_scan =
            modeling::average_from_scan(neutral, arguments.method.model_options().normalisation);
        extent =
            geometry::field_extent(target.surface(), animated.field.mm, export_options.average_from_scan->linear());
    }
    const auto texture = texture_of(neutral, remarks);
    export_options.made_by = made_by(arguments, shelf, neutral.id.name(), neutral.id.subject, chosen);
    for (auto& remark : animation::write_animated_face(base::where_links_lead(arguments.output), animated, neutral,
                                                       chosen.names, texture, export_options))
        remarks.push_back(std::move(remark));
    return report_animation(arguments, neutral.id.name(), chosen, extent);
}

/// Either a subject of the workspace or a mesh with its landmarks.
void check_target(const AnimateArguments& arguments) {
    if (arguments.target.empty() && arguments.mesh.empty())
        throw InputError(
            "--target: is missing (Subject whose first neutral face is animated); give it, or --mesh and --landmarks");
    if (!arguments.target.empty() && !arguments.mesh.empty())
        throw InputError("--mesh: --target names a face, too; give one of them");
    if (!arguments.target.empty() && arguments.workspace.empty())
        throw InputError(fmt::format(
            "--target: '{}' is a subject of a workspace, and none is given; give WORK, the folder that 'mimik "
            "preprocess' made, or --mesh and --landmarks",
            arguments.target));
    const auto extension = base::lower_case(std::filesystem::path(arguments.output).extension().string());
    constexpr std::array written = {".ply", ".obj", ".vtp", ".stl", ".glb"};
    if (!arguments.mesh.empty() && std::find(written.begin(), written.end(), extension) == written.end())
        throw InputError(fmt::format("{}: a mesh of your own is written as .ply, .obj, .vtp, .stl or .glb, not '{}'",
                                     arguments.output, extension));
    if (!arguments.mesh.empty() && (!arguments.hold.empty() || arguments.keep_bridged || arguments.frame != "scanner"))
        throw InputError("--mesh: --hold, --keep-bridged and --frame are for faces of the workspace; leave them out");
}

/// `--au arkit` is a blendshape head at rest, and only that.
void check_arkit(const AnimateArguments& arguments) {
    for (const auto& typed : arguments.action_units)
        if (base::lower_case(typed).starts_with(std::string(all_of_arkit) + ":"))
            throw InputError(
                fmt::format("--au {}: all blendshapes at once are no face; give arkit alone, at rest, and "
                            "expressions at their magnitudes beside it, such as arkit,12:0.5",
                            typed));
    if (!asks_for_arkit(arguments)) return;
    if (base::lower_case(std::filesystem::path(arguments.output).extension().string()) != ".glb")
        throw InputError(fmt::format(
            "--au arkit: {} holds no blendshapes, and at rest nothing moves; give an output that ends in .glb",
            arguments.output));
    if (arguments.combine != "sum")
        throw InputError("--combine parallel: blendshapes of a viewer add up; leave it out beside --au arkit");
}

int run(AnimateArguments& arguments) {
    check_target(arguments);
    if (arguments.action_units.empty() && arguments.model_files.empty())
        throw InputError("there is nothing to animate; give --au, such as 12, or --model, a file of 'mimik model'");
    check_arkit(arguments);
    const ExpressionShelf shelf(arguments.workspace);
    if (const auto* workspace = shelf.workspace())
        for (auto* subject : {&arguments.source, &arguments.target}) {
            if (subject->empty()) continue;
            *subject = subject_named(*workspace, *subject);
            workspace->refuse_hidden(*subject);
        }
    const auto catalogue = arguments.method.catalogue();
    if (!arguments.action_units.empty())
        shelf.check_source({arguments.source, {arguments.target}}, arguments.method.model_options());
    if (arguments.mesh.empty()) {
        auto chosen = choose_expressions(arguments, shelf, catalogue);
        return animate_scan(arguments, shelf, chosen);
    }
    auto own = read_own_mesh(arguments);
    auto chosen = choose_expressions(arguments, shelf, catalogue);
    return animate_own_mesh(arguments, shelf, std::move(own), chosen);
}

}  // namespace

void add_animate_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("animate", "Put expressions of one subject, or of the mean, on a neutral face");
    auto arguments = std::make_shared<AnimateArguments>();
    command->add_option("WORK", arguments->workspace,
                        "Folder made by 'mimik preprocess'; without it a --mesh is moved by the built-in faces");
    command
        ->add_option("--source", arguments->source,
                     "Subject whose expression is taken, or mean (of all but the target)")
        ->capture_default_str();
    command->add_option("--target", arguments->target, "Subject whose first neutral face is animated");
    auto* landmarks = command->add_option("--landmarks", arguments->landmarks, "On the --mesh, by Mimik's names");
    auto* mesh = command->add_option("--mesh", arguments->mesh, "Or a mesh of your own that is animated as it is");
    mesh->needs(landmarks);
    command->add_option("--unit", arguments->unit, "Unit of --mesh and --landmarks: mm, cm, m or inch")
        ->needs(mesh)
        ->capture_default_str();
    command
        ->add_option("--au,--expression", arguments->action_units,
                     "AU or emotion, side and magnitude: 12, 12:0.5, AU4_L, HAPPY:0.8; repeat or 4,12; arkit: all that "
                     "have an ARKit name, at rest")
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
