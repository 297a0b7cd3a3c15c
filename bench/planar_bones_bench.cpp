// One frame of planar bones: 75 markers and 22,500 vertices on one core, and how the time grows with both.

#include <benchmark/benchmark.h>

#include "animation/marker_animator.h"
#include "facs/reference_face.h"

namespace {

using namespace mimik;
using geometry::Point;
using geometry::Vector;

/// A lattice over the reference face.
std::vector<Point> lattice(int columns) {
    std::vector<Point> vertices;
    for (int row = 0; row < columns; ++row)
        for (int col = 0; col < columns; ++col) {
            const double x = -75 + 150.0 * col / (columns - 1), y = -90 + 200.0 * row / (columns - 1);
            vertices.emplace_back(x, y, -10 - x * x / 90);
        }
    return vertices;
}

void planar_bones_frame(benchmark::State& state) {
    const auto& set = capture::builtin_marker_set();
    const auto labels = capture::place_markers(set, facs::reference_landmarks());
    std::vector<std::string> names;
    std::vector<Point> control;
    for (const auto& mark : labels.all()) {
        names.push_back(mark.name);
        control.push_back(mark.position_mm);
    }
    const auto surface = capture::control_surface(set, names);
    const auto vertices = lattice(static_cast<int>(state.range(0)));
    const animation::PlanarBones bones(control, surface.triangles, vertices);
    auto moved = control;
    for (auto& p : moved) p += Vector(0, p.y() < -36 ? -10 : 1, 0);
    std::vector<Vector> displacement(vertices.size());
    for (auto _ : state) {
        bones.displace(moved, displacement);
        benchmark::DoNotOptimize(displacement.data());
    }
    state.counters["vertices"] = static_cast<double>(vertices.size());
    state.counters["bones"] = static_cast<double>(surface.triangles.size());
    state.counters["influences"] = static_cast<double>(bones.influences());
}
BENCHMARK(planar_bones_frame)->Arg(75)->Arg(106)->Arg(150)->Arg(212)->Arg(300)->Unit(benchmark::kMillisecond);

}  // namespace
