#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/animate.h"
#include "animation/face_export.h"
#include "base/errors.h"
#include "base/output_folder.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/expression_names.h"
#include "cli/method_options.h"
#include "cli/notes.h"
#include "cli/regions_file.h"
#include "cli/subject_names.h"
#include "database/hidden_subjects.h"
#include "database/known_databases.h"
#include "io/json_values.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "io/warp_file.h"
#include "modeling/region_labels.h"
#include "modeling/source_expression.h"

namespace mimik::cli {
namespace {

struct Arguments {
    Common common;
    MethodArguments method;
    std::string workspace, source = "mean", target, output, frame = "scanner", combine = "sum";
    std::filesystem::path mesh, landmarks;  ///< animated in the place of a target of the workspace
    std::vector<std::string> action_units, model_files, hold;
    std::string regions;
    bool keep_bridged = false, arkit_names = false;
};

/// A model of a file, as good as one measured now: nobody who must not be shown is in it, and what was made otherwise
/// is said.
modeling::ExpressionModel read_model(const preprocessing::Workspace& workspace, const std::string& file,
                                     const std::string& target, const modeling::ModelProvenance& here,
                                     std::vector<std::string>& remarks) {
    database::refuse_hidden_file(file);  // it may lie in another workspace, whose lists hide others
    auto model = naming(file, [&] { return modeling::read_expression_model(file); });
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

/// What is put on the target: models, each set to a magnitude.
struct Chosen {
    std::vector<modeling::ExpressionModel> models;
    std::vector<animation::NamedMagnitude> names;  ///< one per model
    std::vector<std::string> remarks, failures;

    [[nodiscard]] std::vector<animation::WeightedExpression> weighted() const {
        std::vector<animation::WeightedExpression> expressions;
        for (std::size_t k = 0; k < models.size(); ++k) expressions.push_back({&models[k], names[k].magnitude});
        return expressions;
    }
};

Chosen choose(const Arguments& arguments, const preprocessing::Workspace& workspace,
              const facs::FacsCatalogue& catalogue) {
    Chosen chosen;
    const auto add = [&](modeling::ExpressionModel model, double magnitude) {
        const auto& expression = model.expression;
        chosen.names.push_back({arguments.arkit_names ? facs::arkit_name(catalogue, expression) : expression.name(),
                                magnitude, facs::arkit_shape(catalogue, expression)});
        chosen.models.push_back(std::move(model));
    };
    const modeling::ExpressionSource source{arguments.source, {arguments.target}};
    for (const auto& typed : arguments.action_units) {
        const auto [text, magnitude] = facs::split_magnitude(typed);
        auto model = modeling::model_from_workspace(workspace, catalogue, expression_named(workspace, catalogue, text),
                                                    source, arguments.method.model_options());
        for (const auto& scan : model.unusable_scans)
            chosen.failures.push_back(fmt::format("{}: left out of the mean: {}", model.expression.name(), scan));
        add(std::move(model), magnitude);
    }
    const auto here = arguments.method.provenance(catalogue, workspace.average());
    for (const auto& typed : arguments.model_files) {
        const auto [file, magnitude] =
            std::filesystem::exists(typed) ? facs::TypedMagnitude{typed, 1.0} : facs::split_magnitude(typed);
        auto model = read_model(workspace, file, arguments.target, here, chosen.remarks);
        // The template is bent on to the target once for all models that stand on it.
        if (model.dense) {
            try {
                modeling::share_registrations(*model.dense, workspace.registrations());
            } catch (const InputError&) {
                // The workspace's average face has no template: the model has its own.
            }
            for (const auto& earlier : chosen.models)
                if (earlier.dense) modeling::share_registrations(*model.dense, earlier.dense->registrations);
        }
        add(std::move(model), magnitude);
    }
    return chosen;
}

animation::AnimationOptions animation_options(const Arguments& arguments, const preprocessing::Workspace& workspace,
                                              const preprocessing::Face& neutral) {
    auto options = arguments.method.animation_options();
    options.combination =
        arguments.combine == "parallel" ? animation::Combination::parallel : animation::Combination::sum;
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

std::string source_words(const Arguments& arguments) {
    if (arguments.action_units.empty()) return "model files";
    return arguments.model_files.empty() ? arguments.source : arguments.source + " and model files";
}

/// What a mesh says of how it was made. @param subject  of the target; empty: none of the workspace
io::MadeBy made_by(const Arguments& arguments, const preprocessing::Workspace& workspace, const std::string& target,
                   const std::string& subject, const Chosen& chosen) {
    std::vector<std::string> expressions;
    std::set<std::string> scans;
    for (std::size_t k = 0; k < chosen.models.size(); ++k) {
        expressions.push_back(fmt::format("{} x {}", chosen.models[k].expression.name(), chosen.names[k].magnitude));
        scans.insert(chosen.models[k].sources.begin(), chosen.models[k].sources.end());
    }
    constexpr std::size_t most_named = 8;  // a mean has hundreds
    const auto named =
        scans.size() > most_named ? fmt::format("{} scans", scans.size()) : fmt::format("{}", fmt::join(scans, " "));
    std::set<std::string> subjects;
    if (!subject.empty()) subjects.insert(subject);
    for (const auto& name : scans)
        if (const auto scan = database::parse_scan_name(name)) subjects.insert(scan->subject);
    return {{"made_by", fmt::format("Mimik {} animate", base::version())},
            {"source", fmt::format("{} ({})", source_words(arguments), named)},
            {"target", target},
            {"expressions", fmt::format("{}", fmt::join(expressions, ", "))},
            {"combined_by", arguments.combine},
            {"method", arguments.method.variant_name()},
            {"frame", arguments.frame},
            // Lists of hidden subjects are heeded wherever the mesh goes (database/file_origin.h).
            {"subjects", fmt::format("{}", fmt::join(subjects, " "))},
            {"database", database::remember_database(workspace.database_root())}};
}

void print_json(const Arguments& arguments, const std::string& target, const Chosen& chosen,
                const geometry::FieldExtent& extent) {
    auto list = nlohmann::json::array();
    for (std::size_t k = 0; k < chosen.models.size(); ++k)
        list.push_back({{"expression", chosen.names[k].name},
                        {"magnitude", chosen.names[k].magnitude},
                        {"sources", chosen.models[k].sources},
                        {"points", chosen.models[k].points.size()},
                        {"largest_displacement_mm", chosen.models[k].largest_displacement_mm()}});
    nlohmann::json document = {{"schema", 1},
                               {"target", target},
                               {"source", source_words(arguments)},
                               {"method", arguments.method.name},
                               {"frame", arguments.frame},
                               {"units", "mm"},
                               {"expressions", list},
                               {"largest_displacement_mm", extent.largest_displacement_mm},
                               {"largest_neighbour_step_mm", extent.largest_neighbour_step_mm},
                               {"remarks", chosen.remarks},
                               {"failures", chosen.failures},
                               {"output", arguments.output}};
    if (const auto values = animation::vertex_values_file(arguments.output); arguments.mesh.empty() && !values.empty())
        document["vertex_values"] = values.string();
    std::cout << io::json_text(document);
}

/// What is said at the end, and the exit code.
int report(const Arguments& arguments, const std::string& target, Chosen& chosen, const geometry::FieldExtent& extent) {
    for (const auto& model : chosen.models)
        for (const auto& reason : model.left_out)
            chosen.remarks.push_back(fmt::format("{}: {}", model.expression.name(), reason));
    if (arguments.common.json) {
        print_json(arguments, target, chosen, extent);
    } else {
        if (!arguments.common.quiet) say_notes(chosen.remarks);
        std::vector<std::string> asked = arguments.action_units;
        asked.insert(asked.end(), arguments.model_files.begin(), arguments.model_files.end());
        std::cout << fmt::format("{}: {} from {} on {}, up to {:.1f} mm\n", arguments.output, fmt::join(asked, " + "),
                                 source_words(arguments), target, extent.largest_displacement_mm);
    }
    say_failures(chosen.failures);
    return chosen.failures.empty() ? exit_done : exit_done_with_failures;
}

/// A face of the workspace.
int animate_scan(const Arguments& arguments, const preprocessing::Workspace& workspace, Chosen& chosen) {
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
    export_options.made_by = made_by(arguments, workspace, neutral.id.name(), neutral.id.subject, chosen);
    for (auto& remark : animation::write_animated_face(base::where_links_lead(arguments.output), animated, neutral,
                                                       chosen.names, texture, export_options))
        remarks.push_back(std::move(remark));
    return report(arguments, neutral.id.name(), chosen, extent);
}

std::size_t torn_faces(const geometry::Mesh& mesh, const animation::AnimatedFace& animated) {
    std::size_t torn = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        torn += animation::torn(animated, animated.field.mm, mesh.faces[f]) ? 1 : 0;
    return torn;
}

/// Whoever the mesh shows, by what it says of itself, is heeded in what is made of it, too.
void carry_origin(const Arguments& arguments, io::MadeBy& made_by) {
    const std::array files = {arguments.mesh, arguments.landmarks};
    for (auto& [key, value] : database::said_in_files(database::origin_to_carry(files))) {
        const auto said =
            std::find_if(made_by.begin(), made_by.end(), [&](const auto& entry) { return entry.first == key; });
        if (said == made_by.end())
            made_by.emplace_back(key, value);
        else if (key == "subjects")
            said->second += " " + value;
    }
}

/// Anybody's mesh: its own vertices, faces, texture coordinates and attributes, moved.
int animate_own_mesh(const Arguments& arguments, const preprocessing::Workspace& workspace, Chosen& chosen) {
    for (const auto& file : {arguments.mesh, arguments.landmarks}) database::refuse_hidden_file(file);
    refuse_range_scan(arguments.mesh);
    auto file =
        io::read_mesh_file(arguments.mesh, io::LengthUnit::millimetre, io::MeshParts::all, io::BadTexture::report);
    auto& remarks = chosen.remarks;
    remarks.insert(remarks.end(), file.remarks.begin(), file.remarks.end());
    const auto landmarks = io::read_landmarks(arguments.landmarks, file.mesh.vertices_mm);
    animation::AnimatedFace animated;
    file.mesh = naming_any({arguments.landmarks, arguments.mesh}, [&] {
        return animation::animate_mesh(file.mesh, landmarks, workspace.average(), chosen.weighted(),
                                       arguments.method.animation_options(), &animated);
    });
    remarks.insert(remarks.end(), animated.remarks.begin(), animated.remarks.end());
    if (const auto torn = torn_faces(file.mesh, animated); torn > 0)
        remarks.push_back(fmt::format("{} of {} join lips or lids that part, and are stretched: cut the mesh there",
                                      base::counted(torn, "face"), arguments.mesh.string()));
    const auto output = base::where_links_lead(arguments.output);
    io::MeshWriteOptions options;
    options.made_by = made_by(arguments, workspace, arguments.mesh.filename().string(), "", chosen);
    carry_origin(arguments, options.made_by);
    options.frame = file.frame;
    if (!file.texture_error.empty()) remarks.push_back(file.texture_error);
    if (io::takes_texture(output))
        io::copy_textures(
            file, arguments.mesh, output,
            [](const std::filesystem::path& image) { database::refuse_hidden_file(image); }, options, remarks);
    else if (!file.texture_files.empty())
        remarks.push_back(fmt::format(
            "{}: the format names no image, so the texture is left out; .ply and .obj keep it", arguments.output));
    for (auto& remark : io::write_mesh(output, file.mesh, options)) remarks.push_back(std::move(remark));
    return report(arguments, arguments.mesh.string(), chosen, animated.extent);
}

/// Either a subject of the workspace or a mesh with its landmarks.
void check_target(const Arguments& arguments) {
    if (arguments.target.empty() && arguments.mesh.empty())
        throw InputError(
            "--target: is missing (Subject whose first neutral face is animated); give it, or --mesh and --landmarks");
    if (!arguments.target.empty() && !arguments.mesh.empty())
        throw InputError("--mesh: --target names a face, too; give one of them");
    const auto extension = base::lower_case(std::filesystem::path(arguments.output).extension().string());
    if (!arguments.mesh.empty() && extension != ".ply" && extension != ".obj" && extension != ".vtp" &&
        extension != ".stl")
        throw InputError(fmt::format("{}: a mesh of your own is written as .ply, .obj, .vtp or .stl, not '{}'",
                                     arguments.output, extension));
    if (!arguments.mesh.empty() &&
        (!arguments.hold.empty() || arguments.keep_bridged || arguments.arkit_names || arguments.frame != "scanner"))
        throw InputError(
            "--mesh: --hold, --keep-bridged, --arkit-names and --frame are for faces of the "
            "workspace; leave them out");
}

int run(Arguments& arguments) {
    check_target(arguments);
    const preprocessing::Workspace workspace(arguments.workspace);
    for (auto* subject : {&arguments.source, &arguments.target}) {
        if (subject->empty()) continue;
        *subject = subject_named(workspace, *subject);
        workspace.refuse_hidden(*subject);
    }
    const auto catalogue = arguments.method.catalogue();
    if (arguments.action_units.empty() && arguments.model_files.empty())
        throw InputError("there is nothing to animate; give --au, such as 12, or --model, a file of 'mimik model'");
    if (!arguments.action_units.empty())
        modeling::check_source(workspace, {arguments.source, {arguments.target}}, arguments.method.model_options());
    auto chosen = choose(arguments, workspace, catalogue);
    return arguments.mesh.empty() ? animate_scan(arguments, workspace, chosen)
                                  : animate_own_mesh(arguments, workspace, chosen);
}

}  // namespace

void add_animate_command(CLI::App& app, int& exit_code) {
    auto* command = app.add_subcommand("animate", "Put expressions of one subject, or of the mean, on a neutral face");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("WORK", arguments->workspace, "Folder made by 'mimik preprocess'")->required();
    command
        ->add_option("--source", arguments->source,
                     "Subject whose expression is taken, or mean (of all but the target)")
        ->capture_default_str();
    command->add_option("--target", arguments->target, "Subject whose first neutral face is animated");
    auto* landmarks = command->add_option("--landmarks", arguments->landmarks, "On the --mesh, by Mimik's names");
    command->add_option("--mesh", arguments->mesh, "Or a mesh of your own that is animated as it is")->needs(landmarks);
    command
        ->add_option("--au,--expression", arguments->action_units,
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
