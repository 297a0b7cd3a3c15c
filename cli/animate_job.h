#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "animation/animate.h"
#include "animation/face_export.h"
#include "cli/command.h"
#include "cli/expression_shelf.h"
#include "cli/method_options.h"
#include "io/mesh_io.h"

// What 'mimik animate' does with a face of a workspace and with anybody's mesh.

namespace mimik::cli {

struct AnimateArguments {
    Common common;
    MethodArguments method;
    std::string workspace, source = "mean", target, output, frame = "scanner", combine = "sum";
    std::filesystem::path mesh, landmarks;  ///< animated in the place of a target of the workspace
    std::string unit = "mm";                ///< of both
    std::vector<std::string> action_units, model_files, hold;
    std::string regions;
    bool keep_bridged = false, arkit_names = false;
};

/// What is put on the target: models, each set to a magnitude.
struct ChosenExpressions {
    std::vector<modeling::ExpressionModel> models;
    std::vector<animation::NamedMagnitude> names;  ///< one per model
    std::vector<std::string> remarks, failures;

    [[nodiscard]] std::vector<animation::WeightedExpression> weighted() const;
};

/// @throws InputError for what is not there, listing what is.
[[nodiscard]] ChosenExpressions choose_expressions(const AnimateArguments& arguments, const ExpressionShelf& shelf,
                                                   const facs::FacsCatalogue& catalogue);

[[nodiscard]] animation::Combination combination_of(const AnimateArguments& arguments);

/// What a mesh says of how it was made. @param subject  of the target; empty: none of the workspace
[[nodiscard]] io::MadeBy made_by(const AnimateArguments& arguments, const ExpressionShelf& shelf,
                                 const std::string& target, const std::string& subject,
                                 const ChosenExpressions& chosen);

/// What is said at the end, and the exit code.
[[nodiscard]] int report_animation(const AnimateArguments& arguments, const std::string& target,
                                   ChosenExpressions& chosen, const geometry::FieldExtent& extent);

/// Anybody's mesh with its landmarks, as they were read.
struct OwnMesh {
    io::MeshFile file;
    geometry::Landmarks landmarks;
};
/// @throws InputError naming the file, before any work on expressions.
[[nodiscard]] OwnMesh read_own_mesh(const AnimateArguments& arguments);
/// Its own vertices, faces, texture coordinates and attributes, moved. @return the exit code
[[nodiscard]] int animate_own_mesh(const AnimateArguments& arguments, const ExpressionShelf& shelf, OwnMesh own,
                                   ChosenExpressions& chosen);

/// `--au arkit`: every expression that has an ARKit name.
inline constexpr const char* all_of_arkit = "arkit";
[[nodiscard]] bool asks_for_arkit(const AnimateArguments& arguments);

}  // namespace mimik::cli
