#include <benchmark/benchmark.h>

#include "bench/bench_scan.h"
#include "bench/peers/closest_point_peer.h"
#include "geometry/parallel.h"
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
    geometry::set_thread_count(1);
    for (auto _ : state)
        benchmark::DoNotOptimize(geometry::SurfaceIndex(reference().vertices_mm, reference().triangles));
}
void mimik_query(benchmark::State& state) {
    geometry::set_thread_count(1);
    const geometry::SurfaceIndex index(reference().vertices_mm, reference().triangles);
    for (auto _ : state) benchmark::DoNotOptimize(index.closest(test().vertices_mm));
}
void mimik_build_and_query(benchmark::State& state) {
    geometry::set_thread_count(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        const geometry::SurfaceIndex index(reference().vertices_mm, reference().triangles);
        benchmark::DoNotOptimize(index.closest(test().vertices_mm));
    }
}
void mimik_both_directions(benchmark::State& state) {
    geometry::set_thread_count(static_cast<int>(state.range(0)));
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

BENCHMARK(mimik_build)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_query)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_build_and_query)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(mimik_both_directions)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(peer_build<peers::make_embree_peer>)->Name("embree_build")->Unit(benchmark::kMillisecond);
BENCHMARK(peer_build_and_query<peers::make_embree_peer>)->Name("embree_build_and_query")->Unit(benchmark::kMillisecond);
BENCHMARK(peer_build<peers::make_cgal_peer>)->Name("cgal_build")->Unit(benchmark::kMillisecond);
BENCHMARK(peer_build_and_query<peers::make_cgal_peer>)->Name("cgal_build_and_query")->Unit(benchmark::kMillisecond);

}  // namespace
