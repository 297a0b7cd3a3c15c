#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "animation/animate.h"
#include "animation/feature_vertices.h"
#include "modeling/source_examples.h"

namespace mimik::animation {

/// What an example is made of: Action Units and emotions, each at a magnitude.
struct ExampleRecipe {
    std::string name;
    std::vector<std::string> expressions;  ///< as the command line has them: "12", "25:0.6", "HAPPY"
    std::vector<std::string> arkit;        ///< shapes of ARKit whose mean drives it; empty: none
};

/// What Mimik makes of any face: brows, lids, nose, mouths that show feelings, and mouths that speak. Together they
/// move all that video follows, and no two of them do the same.
[[nodiscard]] std::span<const ExampleRecipe> standard_examples();

struct ExampleModels {
    ExampleRecipe recipe;
    std::vector<WeightedExpression> expressions;
};

/// Examples as fields of a face.
struct MadeExamples {
    AnimatedFace face;                  ///< `shapes` has one field per example; `field` is still
    modeling::SourceExamples features;  ///< what the features of this very face do in each, head's frame
    FeatureVertices feature_vertices;
    std::optional<std::uint32_t> chin;  ///< the vertex there; none without the landmark
    std::vector<std::string> remarks;
};

/// @throws as animate; InputError if an example has no model.
[[nodiscard]] MadeExamples make_examples(const PreparedTarget& target, std::span<const ExampleModels> examples,
                                         const AnimationOptions& options = {});

}  // namespace mimik::animation
