#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "animation/face_export.h"
#include "animation/facial_examples.h"
#include "animation/make_examples.h"
#include "base/errors.h"
#include "base/output_folder.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/expression_shelf.h"
#include "cli/method_options.h"
#include "cli/notes.h"
#include "cli/performance_commands.h"
#include "cli/subject_names.h"
#include "database/file_origin.h"
#include "database/hidden_subjects.h"
#include "database/known_databases.h"
#include "geometry/rim_bays.h"
#include "io/image.h"
#include "io/json_values.h"
#include "io/landmark_io.h"
#include "preprocessing/face_template.h"
#include "report/shaded_face.h"

namespace mimik::cli {
namespace {

constexpr const char* builtin_name = "built-in";

struct Arguments {
    Common common;
    std::string target, output, unit = "mm", source = "auto";
    std::filesystem::path landmarks;
    std::vector<std::string> own;  ///< NAME=EXPRESSIONS
};

/// The face that is moved, and what is needed to write it.
struct Character {
    std::string name, subject;                ///< subject: of a workspace; else empty
    std::optional<preprocessing::Face> face;  ///< of a workspace
    std::optional<io::MeshFile> file;         ///< somebody's mesh
    geometry::FaceSurface surface;
    std::vector<std::uint32_t> upper_lip_line, lower_lip_line;  ///< of the average face
    std::filesystem::path texture_file;
    std::string workspace;
};

/// "smile=12", "mouth_e=25+26:0.5".
animation::ExampleRecipe parse_recipe(const std::string& typed) {
    const auto sign = typed.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == typed.size())
        throw InputError(fmt::format("--example {}: give NAME=EXPRESSIONS, such as smile=12 or mouth_e=25+26:0.5",
                                     base::in_quotes(typed)));
    animation::ExampleRecipe recipe{typed.substr(0, sign), {}, {}};
    std::string_view rest = std::string_view(typed).substr(sign + 1);
    while (!rest.empty()) {
        const auto end = std::min(rest.find('+'), rest.size());
        recipe.expressions.emplace_back(rest.substr(0, end));
        rest = end == rest.size() ? std::string_view() : rest.substr(end + 1);
    }
    return recipe;
}

Character character_of(const Arguments& arguments) {
    Character character;
    const auto colon = arguments.target.rfind(':');
    if (arguments.target == builtin_name) {
        character.name = builtin_name;
        return character;
    }
    if (colon != std::string::npos && std::filesystem::is_directory(arguments.target.substr(0, colon))) {
        character.workspace = arguments.target.substr(0, colon);
        const preprocessing::Workspace workspace(character.workspace);
        character.subject = subject_named(workspace, arguments.target.substr(colon + 1));
        workspace.refuse_hidden(character.subject);
        character.face = workspace.face(workspace.neutral(character.subject));
        character.name = character.face->id.name();
        character.surface = geometry::face_surface(character.face->grid, character.face->landmarks);
        if (std::filesystem::exists(character.face->texture_file))
            character.texture_file = character.face->texture_file;
        return character;
    }
    if (arguments.landmarks.empty())
        throw InputError(fmt::format("{}: a mesh needs --landmarks, by Mimik's names; or give WORK:SUBJECT or {}",
                                     arguments.target, builtin_name));
    for (const auto& file : {std::filesystem::path(arguments.target), arguments.landmarks})
        database::refuse_hidden_file(file);
    refuse_range_scan(arguments.target);
    const auto unit = io::parse_length_unit(arguments.unit);
    character.file = io::read_mesh_file(arguments.target, unit, io::MeshParts::all, io::BadTexture::report);
    character.name = std::filesystem::path(arguments.target).filename().string();
    character.surface = geometry::face_surface(
        character.file->mesh, io::read_landmarks(arguments.landmarks, character.file->mesh.vertices_mm, unit));
    const auto& textures = character.file->texture_files;
    if (textures.size() == 1 && character.file->texture_error.empty()) {
        character.texture_file = std::filesystem::path(arguments.target).parent_path() / textures.front();
        database::refuse_hidden_file(character.texture_file);
    }
    return character;
}

/// The expression itself where somebody shows it, else its units that somebody shows; empty: none of them.
std::vector<facs::Expression> shown_parts(const ExpressionShelf& shelf, const facs::Expression& expression,
                                          const modeling::ExpressionSource& source) {
    if (shelf.shows(expression, source)) return {expression};
    std::vector<facs::Expression> parts;
    if (expression.units().size() < 2) return parts;
    for (const auto& unit : expression.units())
        if (auto part = facs::Expression::of_units({unit}); shelf.shows(part, source)) parts.push_back(std::move(part));
    return parts;
}

/// What an example needs that a shelf does not show; empty: it shows all.
std::string not_shown(const ExpressionShelf& shelf, const facs::FacsCatalogue& catalogue,
                      const std::vector<animation::ExampleRecipe>& recipes, const modeling::ExpressionSource& source) {
    for (const auto& recipe : recipes)
        for (const auto& typed : recipe.expressions) {
            const auto [text, magnitude] = facs::split_magnitude(typed);
            const auto expression = catalogue.expression(text);
            if (shown_parts(shelf, expression, source).empty())
                return fmt::format("{} of example {}", expression.name(), recipe.name);
        }
    return {};
}

struct Models {
    std::vector<std::unique_ptr<modeling::ExpressionModel>> kept;
    std::map<std::string, const modeling::ExpressionModel*> by_name;
    std::set<std::string> scans;
};

std::vector<animation::ExampleModels> models_of(const ExpressionShelf& shelf, const facs::FacsCatalogue& catalogue,
                                                const std::vector<animation::ExampleRecipe>& recipes,
                                                const modeling::ExpressionSource& source,
                                                const modeling::ModelOptions& options, const Common& common,
                                                Models& models) {
    std::vector<animation::ExampleModels> examples;
    Progress progress(common, "examples", recipes.size());
    for (const auto& recipe : recipes) {
        auto& example = examples.emplace_back(animation::ExampleModels{recipe, {}});
        for (const auto& typed : recipe.expressions) {
            const auto [text, magnitude] = facs::split_magnitude(typed);
            for (const auto& part : shown_parts(shelf, catalogue.expression(text), source)) {
                auto& model = models.by_name[part.code()];
                if (!model) {
                    models.kept.push_back(
                        std::make_unique<modeling::ExpressionModel>(shelf.model(catalogue, part, source, options)));
                    model = models.kept.back().get();
                    models.scans.insert(model->sources.begin(), model->sources.end());
                }
                example.expressions.push_back({model, magnitude});
            }
        }
        progress.advance(recipe.name);
    }
    return examples;
}

/// The mesh at rest, and per vertex the vertex of the surface that it moves with. Scans and the average face have no
/// inside of a mouth; they get one.
animation::OpenableSurface resting(const Character& character, const animation::MadeExamples& made) {
    if (character.face) {
        // A scan's holes would be seen through: they are bridged, as in figures.
        auto face = *character.face;
        face.grid = geometry::without_rim_bays(std::move(face.grid));
        return animation::opening_mesh(made.face, face, {.bridged = geometry::BridgedVertices::keep});
    }
    if (character.file) {
        animation::OpenableSurface own{character.file->mesh, {}, character.file->mesh.vertices_mm.size()};
        for (std::uint32_t v = 0; v < own.skin_vertices; ++v) own.moves_with.push_back(v);
        return own;
    }
    geometry::Mesh mesh;
    mesh.vertices_mm = character.surface.vertices_mm;
    for (const auto& t : character.surface.triangles) mesh.faces.add(t);
    return animation::open_between_lines(mesh, character.upper_lip_line, character.lower_lip_line);
}

/// A photograph has no inside of a mouth: a dark band below it is one.
void darken(animation::OpenableSurface& surface, io::Image& texture) {
    constexpr int band = 8;  // pixels: the nearest row of a smaller picture of it is still dark
    const double kept = static_cast<double>(texture.height) / (texture.height + band);
    texture.height += band;
    texture.rgb.reserve(texture.rgb.size() + std::size_t{3} * band * static_cast<std::size_t>(texture.width));
    for (int pixel = 0; pixel < band * texture.width; ++pixel)
        texture.rgb.insert(texture.rgb.end(), animation::inside_colour.begin(), animation::inside_colour.end());
    auto& coordinates = surface.mesh.texture_coordinates;
    for (std::size_t v = 0; v < coordinates.size(); ++v)
        coordinates[v] = v < surface.skin_vertices
                             ? geometry::TextureCoordinate(coordinates[v].x(), 1 - kept * (1 - coordinates[v].y()))
                             : geometry::TextureCoordinate(0.5, 0.5 * (1 - kept));
}

animation::FacialExamples as_examples(const Character& character, const std::vector<animation::ExampleRecipe>& recipes,
                                      const animation::MadeExamples& made, io::Image* texture) {
    animation::FacialExamples set;
    auto surface = resting(character, made);
    const auto source = surface.moves_with;
    if (surface.skin_vertices < source.size()) {
        if (!surface.mesh.texture_coordinates.empty() && texture)
            darken(surface, *texture);
        else
            animation::colour_inside(surface, report::painted_skin);
    }
    set.neutral = std::move(surface.mesh);
    for (std::size_t k = 0; k < recipes.size(); ++k) {
        animation::FacialExample example{recipes[k].name, recipes[k].arkit, {}};
        example.displacement_mm.reserve(source.size());
        for (const auto v : source) example.displacement_mm.push_back(made.face.shapes[k].mm[v]);
        set.examples.push_back(std::move(example));
    }
    std::map<std::uint32_t, std::uint32_t> written;  // of a vertex of the surface; seams may have made it several
    for (std::uint32_t k = 0; k < source.size(); ++k) written.emplace(source[k], k);
    const auto add = [&](const std::string& name, std::uint32_t vertex) {
        if (const auto it = written.find(vertex); it != written.end())
            set.feature_vertices.emplace_back(name, it->second);
    };
    for (std::size_t k = 0; k < made.feature_vertices.names.size(); ++k)
        add(made.feature_vertices.names[k], made.feature_vertices.vertices[k]);
    if (made.chin) add("chin", *made.chin);
    return set;
}

io::MadeBy made_by(const Arguments& arguments, const Character& character, const ExpressionShelf& shelf,
                   const Models& models) {
    std::set<std::string> subjects;
    if (!character.subject.empty()) subjects.insert(character.subject);
    for (const auto& name : models.scans)
        if (const auto scan = database::parse_scan_name(name)) subjects.insert(scan->subject);
    database::FileOrigin origin;
    origin.subjects.assign(subjects.begin(), subjects.end());
    if (!character.workspace.empty()) {
        const preprocessing::Workspace workspace(character.workspace);
        origin.database = database::remember_database(workspace.database_root());
    }
    if (character.file)
        origin = database::united(
            origin, database::united(database::origin_of(arguments.target), database::origin_of(arguments.landmarks)));
    io::MadeBy made = {{"made_by", fmt::format("Mimik {} examples", base::version())},
                       {"source", shelf.workspace() ? "workspace" : builtin_name},
                       {"target", character.name}};
    // Lists of hidden subjects are heeded wherever the mesh goes.
    for (auto& said : database::said_in_files(origin)) made.push_back(std::move(said));
    return made;
}

int run(const Arguments& arguments) {
    std::vector<animation::ExampleRecipe> recipes;
    for (const auto& typed : arguments.own) recipes.push_back(parse_recipe(typed));
    if (recipes.empty()) {
        const auto standard = animation::standard_examples();
        recipes.assign(standard.begin(), standard.end());
    }
    const MethodArguments method;
    const auto catalogue = method.catalogue();
    for (const auto& recipe : recipes)
        for (const auto& typed : recipe.expressions)
            (void)catalogue.expression(facs::split_magnitude(typed).text);  // before the work
    auto character = character_of(arguments);
    base::check_takes_files(arguments.output);
    std::vector<std::string> remarks;
    modeling::ExpressionSource source{"mean", {}};
    if (!character.subject.empty()) source.excluded = {character.subject};
    auto shelf = std::make_unique<ExpressionShelf>(arguments.source == builtin_name ? "" : character.workspace);
    if (shelf->workspace())
        if (const auto lacks = not_shown(*shelf, catalogue, recipes, source); !lacks.empty()) {
            if (arguments.source == "workspace")
                throw InputError(
                    fmt::format("--source workspace: nobody in {} shows {}; leave it out, or take the "
                                "built-in expressions",
                                character.workspace, lacks));
            remarks.push_back(fmt::format("{}: nobody shows {}, so all examples are those of the built-in faces",
                                          character.workspace, lacks));
            shelf = std::make_unique<ExpressionShelf>("");
        }
    Models models;
    const auto parts = models_of(*shelf, catalogue, recipes, source, method.model_options(), arguments.common, models);
    if (character.name == builtin_name) {
        auto average = preprocessing::build_face_template(shelf->average());
        character.surface = std::move(average.surface);
        character.upper_lip_line = std::move(average.upper_lip_line);
        character.lower_lip_line = std::move(average.lower_lip_line);
    }
    const auto of_face = shelf->workspace() && character.face;
    const auto made = naming_any({arguments.target}, [&] {
        const auto target = of_face ? animation::PreparedTarget(*character.face)
                                    : animation::PreparedTarget(character.surface, shelf->average(), character.name);
        return animation::make_examples(target, parts, method.animation_options());
    });
    remarks.insert(remarks.end(), made.remarks.begin(), made.remarks.end());
    std::optional<io::Image> texture;
    const bool has_coordinates = character.face   ? !character.face->grid.texture_coordinates.empty()
                                 : character.file ? !character.file->mesh.texture_coordinates.empty()
                                                  : false;
    if (has_coordinates && !character.texture_file.empty()) {
        try {
            texture = io::read_image(character.texture_file);
        } catch (const InputError& e) {
            remarks.push_back(fmt::format("the face has no picture: {}", e.what()));
        }
    }
    auto set = as_examples(character, recipes, made, texture ? &*texture : nullptr);
    const std::filesystem::path folder = arguments.output;
    if (texture) {
        set.texture_file = folder / "neutral_texture.png";
        io::write_png(set.texture_file, *texture);
    }
    if (!made.features.features.empty()) {
        set.features_file = folder / "features.csv";
        modeling::write_source_examples(set.features_file, made.features);
    }
    animation::write_facial_examples(folder, set, made_by(arguments, character, *shelf, models));
    if (arguments.common.json) {
        auto list = nlohmann::json::array();
        for (const auto& example : set.examples) {
            double largest = 0;
            for (const auto& d : example.displacement_mm) largest = std::max(largest, d.norm());
            list.push_back({{"name", example.name}, {"largest_displacement_mm", largest}});
        }
        std::cout << io::json_text(nlohmann::json{{"schema", 1},
                                                  {"output", arguments.output},
                                                  {"vertices", set.neutral.vertices_mm.size()},
                                                  {"features", made.features.features.size()},
                                                  {"examples", list},
                                                  {"remarks", remarks}});
        return exit_done;
    }
    if (!arguments.common.quiet) say_notes(remarks);
    std::cout << fmt::format("{}: {} of {}, {}, {}\n", arguments.output, base::counted(set.examples.size(), "example"),
                             character.name, base::counted(set.neutral.vertices_mm.size(), "vertex", "vertices"),
                             base::counted(made.features.features.size(), "feature"));
    return exit_done;
}

}  // namespace

void add_examples_command(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<Arguments>();
    auto* command = app.add_subcommand("examples", "Make facial examples of a character, for 'mimik perform'");
    command
        ->add_option("FACE", arguments->target,
                     "WORK:SUBJECT of a workspace, a mesh with --landmarks, or built-in (the average face)")
        ->required();
    command->add_option("--landmarks", arguments->landmarks, "On the mesh, by Mimik's names");
    command->add_option("--unit", arguments->unit, "Unit of mesh and landmarks: mm, cm, m or inch")
        ->capture_default_str();
    command->add_option("--example", arguments->own,
                        "NAME=EXPRESSIONS, such as smile=12 or mouth_e=25+26:0.5; repeat (default: 18 that Mimik has)");
    command
        ->add_option(
            "--source", arguments->source,
            "Whose expressions: workspace (mean of its subjects), built-in, or auto (workspace if it shows all)")
        ->check(CLI::IsMember({"auto", "workspace", builtin_name}))
        ->capture_default_str();
    add_output_folder(*command, arguments->output, "Folder for meshes, features.csv and examples.toml");
    add_common_options(*command, arguments->common);
    command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace mimik::cli
