#include <vector>

#include <benchmark/benchmark.h>

#include "animation/blend_examples.h"
#include "animation/expression_mapping.h"
#include "base/random_stream.h"

// One frame of a performance: features of a performer to weights, weights to the vertices of a face. One thread.

namespace {

using namespace mimik;
using geometry::Point;
using geometry::Vector;

Vector drawn(base::RandomStream& chance, double size_mm) {
    return size_mm * Vector(chance.normal(), chance.normal(), chance.normal());
}

/// 48 features, as capture::face_features() has.
modeling::SourceExamples source(std::size_t examples) {
    base::RandomStream chance(3);
    modeling::SourceExamples made;
    for (const auto& feature : capture::face_features()) {
        made.features.emplace_back(feature.name);
        made.neutral_mm.push_back(drawn(chance, 40));
    }
    for (std::size_t i = 0; i < examples; ++i) {
        made.examples.push_back("example" + std::to_string(i));
        auto& row = made.displacement_mm.emplace_back();
        for (std::size_t k = 0; k < made.features.size(); ++k) row.push_back(drawn(chance, 3));
    }
    return made;
}

animation::ExampleBlender character(std::size_t examples, std::size_t vertices) {
    base::RandomStream chance(5);
    std::vector<Point> neutral;
    for (std::size_t v = 0; v < vertices; ++v) neutral.emplace_back(drawn(chance, 60));
    std::vector<std::vector<Vector>> moved(examples);
    for (auto& example : moved)
        for (std::size_t v = 0; v < vertices; ++v) example.push_back(drawn(chance, 3));
    return {std::move(neutral), moved};
}

void mapping(benchmark::State& state) {
    const auto examples = source(static_cast<std::size_t>(state.range(0)));
    const animation::ExpressionMapping mapping(examples);
    const std::vector<std::uint8_t> valid(examples.features.size(), 1);
    for (auto _ : state) benchmark::DoNotOptimize(mapping.map(examples.displacement_mm[1], valid));
    state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
}

/// Every example is active and moves every vertex: the worst there is.
void mapping_and_blending(benchmark::State& state) {
    const auto examples = source(static_cast<std::size_t>(state.range(0)));
    const animation::ExpressionMapping mapping(examples);
    const auto blender = character(static_cast<std::size_t>(state.range(0)), static_cast<std::size_t>(state.range(1)));
    const std::vector<std::uint8_t> valid(examples.features.size(), 1);
    std::vector<Vector> between(examples.features.size());
    for (std::size_t k = 0; k < between.size(); ++k)
        between[k] = 0.4 * examples.displacement_mm[0][k] + 0.3 * examples.displacement_mm[1][k];
    std::vector<Point> face(blender.vertices());
    for (auto _ : state) {
        const auto mapped = mapping.map(between, valid);
        blender.blend({mapped.weights.data(), static_cast<std::size_t>(mapped.weights.size())}, face);
        benchmark::DoNotOptimize(face.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
}

BENCHMARK(mapping)->Arg(13)->Arg(26)->Arg(52);
BENCHMARK(mapping_and_blending)
    ->Args({13, 22500})
    ->Args({26, 22500})
    ->Args({52, 22500})
    ->Args({13, 5625})
    ->Args({13, 90000})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
