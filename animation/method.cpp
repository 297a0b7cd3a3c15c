#include "animation/method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"

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

geometry::Mesh animate_mesh(const geometry::Mesh& mesh, const geometry::Landmarks& landmarks,
                            const preprocessing::AverageFace& average, const Transfer& transfer, double magnitude) {
    const PreparedTarget target(geometry::face_surface(mesh, landmarks), average);
    auto field = transfer.on(target);
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
