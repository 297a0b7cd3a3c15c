#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "animation/animate.h"
#include "facs/facs_catalogue.h"
#include "geometry/thin_plate_spline.h"
#include "modeling/expression_model.h"

namespace mimik::cli {

/// The methods that a user may ask for.
[[nodiscard]] std::vector<std::string> method_names();

/// What is wrong with a --method that is none of `choices`: it may be one that other commands take.
[[nodiscard]] std::string fault_of_method(const std::string& name, const std::vector<std::string>& choices);

/// All of them with what they do, in groups: 'mimik help methods'.
[[nodiscard]] std::string methods_text(bool colours);

/// Of --kernel, which the parser has found to be r or r2logr.
[[nodiscard]] geometry::SplineKernel kernel_by_name(const std::string& name);

/// --method and the single switches that differ from it; shared by the commands that model and animate.
struct MethodArguments {
    std::string name = "default";
    std::string catalogue_file;                      ///< empty: the catalogue that Mimik ships
    std::string emotions = facs::usual_emotion_set;  ///< which prototypes the catalogue's emotions have
    std::string kernel;                              ///< empty: as the method has it
    bool no_anchors = false;

    enum class Methods { by_control_points, all };
    void add_to(CLI::App& command, Methods methods = Methods::by_control_points);
    /// Whether it has model_options() and animation_options(). @throws InputError if it has none and a switch is given.
    [[nodiscard]] bool has_control_points() const;
    [[nodiscard]] facs::FacsCatalogue catalogue() const;
    [[nodiscard]] modeling::ModelOptions model_options() const;
    [[nodiscard]] animation::AnimationOptions animation_options() const;
    /// What a model made by these switches says of itself.
    [[nodiscard]] modeling::ModelProvenance provenance(const facs::FacsCatalogue& catalogue,
                                                       const preprocessing::AverageFace& average) const;
    /// "sparse", and what the switches change of it: "sparse_r2logr_no-anchors_catalogue-mine".
    [[nodiscard]] std::string variant_name() const;
};

}  // namespace mimik::cli
