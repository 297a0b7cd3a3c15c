#include <cstdlib>
#include <iostream>
#include <random>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "bench/bench_scan.h"
#include "bench/peers/thin_plate_spline_peer.h"
#include "geometry/thin_plate_spline.h"

namespace {

using namespace mimik;
using geometry::Point;

struct Controls {
    std::vector<Point> source_mm, target_mm;
};

/// Points of the face surface, and where they go: up to 5 mm off.
Controls make_controls(std::size_t count) {
    const auto surface = bench::make_surface(1, 0.0);
    std::mt19937_64 engine(count);
    const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0; };
    Controls controls;
    for (std::size_t i = 0; i < count; ++i) {
        controls.source_mm.push_back(surface.vertices_mm[(i * 7919 + 1000) % surface.vertices_mm.size()]);
        controls.target_mm.push_back(controls.source_mm.back() + 5 * Point(uniform(), uniform(), uniform()));
    }
    return controls;
}

const std::vector<Point>& grid() {
    static const auto surface = bench::make_surface(1, 0.0);
    return surface.vertices_mm;
}

/// A rival that computes something else is no rival.
void require_agreement(const std::vector<Point>& ours, const std::vector<Point>& theirs) {
    for (std::size_t i = 0; i < ours.size(); ++i)
        if (!((ours[i] - theirs[i]).norm() < 1e-6)) {
            std::cerr << "the splines differ by " << (ours[i] - theirs[i]).norm() << " mm at vertex " << i << '\n';
            std::exit(1);
        }
}

void fit(benchmark::State& state, geometry::SplineKernel kernel) {
    const auto controls = make_controls(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(
            geometry::ThinPlateSpline::fit(controls.source_mm, controls.target_mm, {.kernel = kernel}));
}

void evaluate(benchmark::State& state, geometry::SplineKernel kernel, int threads) {
    base::set_thread_count(threads);
    const auto controls = make_controls(static_cast<std::size_t>(state.range(0)));
    const auto spline = geometry::ThinPlateSpline::fit(controls.source_mm, controls.target_mm, {.kernel = kernel});
    std::vector<Point> moved(grid().size());
    for (auto _ : state) {
        spline.apply(grid(), moved);
        benchmark::DoNotOptimize(moved.data());
        benchmark::ClobberMemory();
    }
}

void vtk_fit(benchmark::State& state) {
    const auto controls = make_controls(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(peers::make_vtk_peer(controls.source_mm, controls.target_mm));
}

void vtk_evaluate(benchmark::State& state) {
    base::set_thread_count(1);
    const auto controls = make_controls(static_cast<std::size_t>(state.range(0)));
    const auto peer = peers::make_vtk_peer(controls.source_mm, controls.target_mm);
    require_agreement(geometry::ThinPlateSpline::fit(controls.source_mm, controls.target_mm,
                                                     {.kernel = geometry::SplineKernel::r2_log_r2})
                          .apply(grid()),
                      peer->apply(grid()));
    for (auto _ : state) benchmark::DoNotOptimize(peer->apply(grid()));
}

constexpr auto r2_log_r2 = geometry::SplineKernel::r2_log_r2;
void mimik_spline_fit(benchmark::State& state) { fit(state, r2_log_r2); }
void mimik_spline_fit_kernel_r(benchmark::State& state) { fit(state, geometry::SplineKernel::r); }
void mimik_spline_evaluate(benchmark::State& state) { evaluate(state, r2_log_r2, 1); }
void mimik_spline_evaluate_on_2_threads(benchmark::State& state) { evaluate(state, r2_log_r2, 2); }
void mimik_spline_evaluate_kernel_r(benchmark::State& state) { evaluate(state, geometry::SplineKernel::r, 1); }

void controls(benchmark::internal::Benchmark* bench) {
    bench->Arg(22)->Arg(40)->Arg(100)->Arg(500)->Unit(benchmark::kMillisecond);
}
void few_controls(benchmark::internal::Benchmark* bench) {  // VTK's fit of 500 takes seconds
    bench->Arg(22)->Arg(40)->Arg(100)->Unit(benchmark::kMillisecond);
}

BENCHMARK(mimik_spline_fit)->Apply(controls);
BENCHMARK(vtk_fit)->Name("vtk_spline_fit")->Apply(few_controls);
BENCHMARK(mimik_spline_fit_kernel_r)->Apply(controls);
BENCHMARK(mimik_spline_evaluate)->Apply(controls);
BENCHMARK(vtk_evaluate)->Name("vtk_spline_evaluate")->Apply(few_controls);
BENCHMARK(mimik_spline_evaluate_kernel_r)->Apply(controls);
BENCHMARK(mimik_spline_evaluate_on_2_threads)->Apply(controls)->UseRealTime();

}  // namespace
