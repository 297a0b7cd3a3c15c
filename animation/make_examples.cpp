#include "animation/make_examples.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::animation {

std::span<const ExampleRecipe> standard_examples() {
    static const std::array<ExampleRecipe, 18> recipes = {{
        {"brows_up", {"1", "2"}, {"browInnerUp", "browOuterUpLeft", "browOuterUpRight"}},
        {"brows_down", {"4"}, {"browDownLeft", "browDownRight"}},
        {"eyes_wide", {"5"}, {"eyeWideLeft", "eyeWideRight"}},
        {"eye_closed_left", {"43L"}, {"eyeBlinkLeft"}},
        {"eye_closed_right", {"43R"}, {"eyeBlinkRight"}},
        {"nose_wrinkled", {"9"}, {"noseSneerLeft", "noseSneerRight"}},
        {"lip_raised", {"10"}, {"mouthUpperUpLeft", "mouthUpperUpRight"}},
        {"smile_left", {"12L"}, {"mouthSmileLeft"}},
        {"smile_right", {"12R"}, {"mouthSmileRight"}},
        {"frown", {"15"}, {"mouthFrownLeft", "mouthFrownRight"}},
        {"chin_raised", {"17"}, {"mouthShrugLower"}},
        {"lips_stretched", {"20"}, {"mouthStretchLeft", "mouthStretchRight"}},
        {"mouth_u", {"18"}, {"mouthPucker"}},
        {"mouth_o", {"22", "26:0.5"}, {}},
        {"mouth_a", {"27"}, {"jawOpen"}},
        {"mouth_e", {"25", "26:0.5", "20:0.6"}, {}},
        {"mouth_m", {"24"}, {"mouthPressLeft", "mouthPressRight"}},
        {"anger", {"ANGER"}, {}},
    }};
    return recipes;
}

MadeExamples make_examples(const PreparedTarget& target, std::span<const ExampleModels> examples,
                           const AnimationOptions& options) {
    MadeExamples made;
    for (const auto& example : examples) {
        if (example.expressions.empty())
            throw InputError(fmt::format("example {} has no expression; give it at least one",
                                         base::in_quotes(example.recipe.name)));
        auto animated = animate(target, example.expressions, options);
        if (made.face.lip_sides.empty()) made.face.lip_sides = std::move(animated.lip_sides);
        if (made.face.lid_sheets.empty()) made.face.lid_sheets = std::move(animated.lid_sheets);
        for (auto& remark : animated.remarks)
            made.remarks.push_back(fmt::format("{}: {}", example.recipe.name, std::move(remark)));
        made.face.shapes.push_back(std::move(animated.field));
    }
    made.face.field = geometry::DisplacementField::still(target.surface().size());
    made.feature_vertices = feature_vertices(target, made.face.lip_sides);
    const auto& [names, vertices, remarks] = made.feature_vertices;
    made.remarks.insert(made.remarks.end(), remarks.begin(), remarks.end());
    if (const auto* chin = target.surface().landmarks.find("chin")) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::uint32_t v = 0; v < target.surface().size(); ++v) {
            if (!target.surface().present[v]) continue;
            const double distance = (target.surface().vertices_mm[v] - chin->position_mm).squaredNorm();
            if (distance < nearest) made.chin = v;
            nearest = std::min(nearest, distance);
        }
    }
    const auto head = head_from_target(target);
    made.features.features = names;
    for (const auto v : vertices) made.features.neutral_mm.emplace_back(head * target.surface().vertices_mm[v]);
    for (std::size_t k = 0; k < examples.size(); ++k) {
        made.features.examples.push_back(examples[k].recipe.name);
        auto& row = made.features.displacement_mm.emplace_back();
        for (const auto v : vertices) row.emplace_back(head.linear() * made.face.shapes[k].mm[v]);
    }
    return made;
}

}  // namespace mimik::animation
