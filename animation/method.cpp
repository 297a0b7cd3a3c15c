#include "animation/method.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"

// Written by animation/CMakeLists.txt: a declaration for every file of animation/methods/, and methods::all().
#include "animation/methods.inc"

namespace mimik::animation {

const char* to_string(SourceKind kind) {
    return kind == SourceKind::none ? "none" : kind == SourceKind::one_source ? "one source" : "mean";
}

std::unique_ptr<const Transfer> learn(const Method& method, const LearningTask& task,
                                      std::span<const modeling::Performance> performances) {
    const auto learner = method.learner(task);
    std::vector<LessonPointer> lessons;
    for (const auto& performance : performances) lessons.push_back(learner->study(performance));
    return learner->learn(lessons);
}

geometry::DisplacementField field_on(const Transfer& transfer, const PreparedTarget& target) {
    auto field = transfer.on(target);
    const auto vertices = target.surface().size();
    if (field.mm.size() != vertices || field.answered.size() != vertices)
        throw InputError(fmt::format("the method gave {} and {} for {}; it has to give one of each per vertex",
                                     base::counted(field.mm.size(), "displacement"),
                                     base::counted(field.answered.size(), "answer"),
                                     base::counted(vertices, "vertex", "vertices")));
    for (std::size_t v = 0; v < vertices; ++v) {
        if (!field.answered[v])
            field.mm[v].setZero();
        else if (!field.mm[v].allFinite())
            throw NumericalError(fmt::format("the displacement of vertex {} is no finite number", v));
    }
    return field;
}

geometry::Mesh animate_mesh(const geometry::Mesh& mesh, const geometry::Landmarks& landmarks,
                            const preprocessing::AverageFace& average, const Transfer& transfer, double magnitude) {
    if (!std::isfinite(magnitude) || magnitude < 0)
        throw InputError(fmt::format("magnitude is {}; give 0 (neutral) or more", magnitude));
    const PreparedTarget target(geometry::face_surface(mesh, landmarks), average);
    auto field = field_on(transfer, target);
    for (auto& displacement : field.mm) displacement *= magnitude;
    return geometry::moved(mesh, field);
}

std::vector<MethodPointer> known_methods() { return methods::all(); }

MethodPointer method_by_name(const std::string& name) {
    std::vector<std::string> names;
    for (const auto& method : known_methods()) {
        if (method->name() == name) return method;
        names.push_back(method->name());
    }
    throw InputError(fmt::format("method '{}' is unknown; there are: {}", name, fmt::join(names, ", ")));
}

}  // namespace mimik::animation
