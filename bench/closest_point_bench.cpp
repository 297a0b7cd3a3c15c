#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "bench/bench_scan.h"
#include "bench/peers/closest_point_peer.h"
#include "geometry/surface_index.h"

namespace {

using namespace mimik;

const auto& reference() {
    static const auto surface = bench::make_surface(1, 0.0);
    return surface;
}
const auto& test() {
    static const auto surface = bench::make_surface(2, 4.0);
    return surface;
}

void mimik_build(benchmark::State& state) {
    base::set_thread_count(1);
    for (auto _ : state)
        benchmark::DoNotOptimize(geometry::SurfaceIndex(reference().vertices_mm, reference().triangles));
}
void mimik_query(benchmark::State& state) {
    base::set_thread_count(1);
    const geometry::SurfaceIndex index(reference().vertices_mm, reference().triangles);
    for (auto _ : state) benchmark::DoNotOptimize(index.closest(test().vertices_mm));
}
void mimik_build_and_query(benchmark::State& state, int threads) {
    base::set_thread_count(threads);
    for (auto _ : state) {
        const geometry::SurfaceIndex index(reference().vertices_mm, reference().triangles);
        benchmark::DoNotOptimize(index.closest(test().vertices_mm));
    }
}
void mimik_both_directions(benchmark::State& state, int threads) {
    base::set_thread_count(threads);
    for (auto _ : state) {
        const geometry::SurfaceIndex one(reference().vertices_mm, reference().triangles);
        benchmark::DoNotOptimize(one.closest(test().vertices_mm));
        const geometry::SurfaceIndex other(test().vertices_mm, test().triangles);
        benchmark::DoNotOptimize(other.closest(reference().vertices_mm));
    }
}

template <auto make>
void peer_build(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(make(reference().vertices_mm, reference().triangles));
}
template <auto make>
void peer_build_and_query(benchmark::State& state) {
    for (auto _ : state) {
        const auto peer = make(reference().vertices_mm, reference().triangles);
        for (const auto& q : test().vertices_mm) benchmark::DoNotOptimize(peer->closest(q));
    }
}

// Named tool_task, so that tools stand side by side in the table.
#define MILLISECONDS Unit(benchmark::kMillisecond)
BENCHMARK(mimik_build)->Name("mimik_surface_build")->MILLISECONDS;
BENCHMARK(mimik_query)->Name("mimik_surface_query")->MILLISECONDS;
BENCHMARK_CAPTURE(mimik_build_and_query, one, 1)->Name("mimik_surface_build_and_query")->MILLISECONDS;
BENCHMARK_CAPTURE(mimik_build_and_query, two, 2)
    ->Name("mimik_surface_build_and_query_two_threads")
    ->MILLISECONDS->UseRealTime();
BENCHMARK_CAPTURE(mimik_both_directions, one, 1)->Name("mimik_surface_both_directions")->MILLISECONDS;
BENCHMARK_CAPTURE(mimik_both_directions, two, 2)
    ->Name("mimik_surface_both_directions_two_threads")
    ->MILLISECONDS->UseRealTime();
BENCHMARK(peer_build<peers::make_embree_peer>)->Name("embree_surface_build")->MILLISECONDS;
BENCHMARK(peer_build_and_query<peers::make_embree_peer>)->Name("embree_surface_build_and_query")->MILLISECONDS;
BENCHMARK(peer_build<peers::make_cgal_peer>)->Name("cgal_surface_build")->MILLISECONDS;
BENCHMARK(peer_build_and_query<peers::make_cgal_peer>)->Name("cgal_surface_build_and_query")->MILLISECONDS;

}  // namespace
