#include <cstdlib>
#include <iostream>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "bench/bench_scan.h"
#include "bench/peers/nearest_neighbour_peer.h"
#include "geometry/point_index.h"

namespace {

using namespace mimik;

const auto& cloud() {
    static const auto surface = bench::make_surface(1, 0.0);
    return surface.vertices_mm;
}
const auto& queries() {
    static const auto surface = bench::make_surface(2, 4.0);
    return surface.vertices_mm;
}

void mimik_neighbour_build(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(geometry::PointIndex(cloud()));
}
void mimik_neighbour_query(benchmark::State& state) {
    base::set_thread_count(1);
    const geometry::PointIndex index(cloud());
    for (auto _ : state) benchmark::DoNotOptimize(index.nearest(queries()));
}

template <auto make>
void peer_build(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(make(cloud()));
}
template <auto make>
void peer_query(benchmark::State& state) {
    base::set_thread_count(1);
    const auto peer = make(cloud());
    const auto theirs = peer->nearest(queries());
    const auto ours = geometry::PointIndex(cloud()).nearest(queries());
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const double distance = (cloud()[theirs[i]] - queries()[i]).norm();
        if (!(std::abs(distance - ours[i].distance_mm) < 1e-4)) {  // single precision may take another one
            std::cerr << "query " << i << ": " << distance << " mm against " << ours[i].distance_mm << " mm\n";
            std::exit(1);
        }
    }
    for (auto _ : state) benchmark::DoNotOptimize(peer->nearest(queries()));
}

BENCHMARK(mimik_neighbour_build)->Unit(benchmark::kMillisecond);
BENCHMARK(peer_build<peers::make_nanoflann_peer>)->Name("nanoflann_neighbour_build")->Unit(benchmark::kMillisecond);
BENCHMARK(peer_build<peers::make_cgal_neighbour_peer>)->Name("cgal_neighbour_build")->Unit(benchmark::kMillisecond);
BENCHMARK(peer_build<peers::make_pcl_peer>)->Name("pcl_neighbour_build")->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_neighbour_query)->Unit(benchmark::kMillisecond);
BENCHMARK(peer_query<peers::make_nanoflann_peer>)->Name("nanoflann_neighbour_query")->Unit(benchmark::kMillisecond);
BENCHMARK(peer_query<peers::make_cgal_neighbour_peer>)->Name("cgal_neighbour_query")->Unit(benchmark::kMillisecond);
BENCHMARK(peer_query<peers::make_pcl_peer>)->Name("pcl_neighbour_query")->Unit(benchmark::kMillisecond);

}  // namespace
