#include <optional>

#include <benchmark/benchmark.h>

#include "animation/animate.h"
#include "base/parallel.h"
#include "builtin/builtin_expressions.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/kept_registrations.h"
#include "preprocessing/neutral_alignment.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/preprocess_scan.h"
#include "preprocessing/stable_region.h"
#include "synthesis/scanner.h"
#include "synthesis/subject.h"

// Dense correspondence: a template on a neutral scan, on an expressive scan with the search for its pose, and an Action
// Unit on a face that the template lies on. Scans of the built-in face model, with a scanner's noise and holes. No
// package of Debian 12 does the same job; docs/benchmarks.md has figures of one that is not packaged.

namespace {

using namespace mimik;

/// A person at rest and smiling, preprocessed but for the pose of the smile.
struct Scans {
    builtin::BuiltinExpressions expressions{{.people = 3}};
    preprocessing::KeptRegistrations registrations{expressions.average()};
    modeling::ExpressionModel smile =
        expressions.model(facs::builtin_catalogue(), facs::builtin_catalogue().expression("12"));
    preprocessing::Face neutral, smiling;

    Scans() {
        const auto model = synthesis::make_builtin_face_model();
        const auto subject = synthesis::draw_subject(*model, "bench", 7);
        const auto window = synthesis::face_window(*model, subject.resting_mm);
        const auto scan = [&](const char* code, const char* group) {
            database::LoadedScan loaded;
            loaded.entry.id = {"bench", group, code, 0};
            const auto name = loaded.entry.id.name();
            const auto posed = synthesis::perform(subject, synthesis::make_expression(code), name, 7);
            auto made = synthesis::scan_face(*model, posed.vertices_mm, window, name, 7);
            loaded.scan = std::move(made.scan);
            loaded.landmarks = std::move(made.landmarks);
            return preprocessing::preprocess_scan(loaded);
        };
        neutral = scan("N", "N");
        neutral.average_from_scan =
            preprocessing::similarity_normalisation(neutral.landmarks, expressions.average().landmarks);
        smiling = scan("12", "LFAU");
        (void)registrations.registration();
    }
    /// Finds the pose of the smile.
    void tie(preprocessing::Face& face) const {
        const auto stable = preprocessing::stable_vertices(facs::builtin_catalogue(), face.id.expression(), neutral);
        preprocessing::align_to_neutral(face, neutral, stable);
        face.average_from_scan = neutral.average_from_scan * face.neutral_from_scan;
    }
};

const Scans& scans() {
    base::set_thread_count(1);
    static const Scans made;
    return made;
}

void mimik_template_on_a_neutral_scan(benchmark::State& state) {
    const auto& registration = scans().registrations.registration();
    for (auto _ : state) benchmark::DoNotOptimize(registration.neutral(scans().neutral));
    state.counters["vertices"] = static_cast<double>(registration.face_template().size());
}

void mimik_template_on_an_expression_with_its_pose(benchmark::State& state) {
    const auto& registration = scans().registrations.registration();
    const auto rest = registration.neutral(scans().neutral);
    auto face = scans().smiling;
    for (auto _ : state) {
        scans().tie(face);
        benchmark::DoNotOptimize(registration.motion(scans().neutral, rest, face));
    }
}

void mimik_template_of_an_average_face(benchmark::State& state) {
    (void)scans();
    for (auto _ : state)
        benchmark::DoNotOptimize(preprocessing::KeptRegistrations(scans().expressions.average()).registration());
}

void mimik_expression_on_a_registered_face(benchmark::State& state) {
    const animation::PreparedTarget target(scans().neutral);
    const animation::WeightedExpression weighted{&scans().smile, 1.0};
    (void)animation::animate(target, std::span(&weighted, 1));  // the template is bent on to the face once
    for (auto _ : state) benchmark::DoNotOptimize(animation::animate(target, std::span(&weighted, 1)));
}

void mimik_builtin_expressions_made(benchmark::State& state) {
    (void)scans();
    for (auto _ : state) benchmark::DoNotOptimize(builtin::BuiltinExpressions().average());
}

BENCHMARK(mimik_template_of_an_average_face)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_template_on_a_neutral_scan)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_template_on_an_expression_with_its_pose)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_expression_on_a_registered_face)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_builtin_expressions_made)->Unit(benchmark::kMillisecond);

}  // namespace
