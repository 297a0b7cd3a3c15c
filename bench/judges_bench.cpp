#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "bench/bench_scan.h"
#include "bench/peers/pcl_judges.h"
#include "geometry/mesh.h"
#include "preprocessing/cleaning.h"
#include "preprocessing/pcl_cleaning.h"
#include "preprocessing/rigid_alignment.h"

namespace {

using namespace mimik;

constexpr int pcl_iterations = 100;
constexpr double max_distance_mm = 15;

const auto& target() {
    static const auto surface = bench::make_surface(1, 0.0);
    return surface;
}

geometry::Transform motion() {
    return geometry::Transform(Eigen::Translation3d(0.3, -0.2, 0.4) *
                               Eigen::AngleAxisd(0.004, geometry::Point(0.2, 1, -0.3).normalized()));
}

/// 2,000 vertices of the target, moved off it.
const auto& source() {
    static const auto points = [] {
        std::vector<geometry::Point> some;
        const auto& all = target().vertices_mm;
        for (std::size_t k = 0; k < 2000; ++k) some.push_back(motion().inverse() * all[k * all.size() / 2000]);
        return some;
    }();
    return points;
}

geometry::Transform our_alignment() {
    return preprocessing::align_rigidly(source(), geometry::SurfaceIndex(target().vertices_mm, target().triangles))
        .target_from_source;
}

void mimik_rigid_alignment(benchmark::State& state) {
    base::set_thread_count(1);
    for (auto _ : state) benchmark::DoNotOptimize(our_alignment());
}
void pcl_rigid_alignment(benchmark::State& state) {
    base::set_thread_count(1);
    const auto theirs = peers::align_with_pcl(source(), target().vertices_mm, max_distance_mm, pcl_iterations);
    const auto ours = our_alignment();
    for (const auto& p : source())
        if (!((ours * p - theirs * p).norm() < 0.1)) {
            std::cerr << "the alignments are " << (ours * p - theirs * p).norm() << " mm apart\n";
            std::exit(1);
        }
    for (auto _ : state)
        benchmark::DoNotOptimize(
            peers::align_with_pcl(source(), target().vertices_mm, max_distance_mm, pcl_iterations));
}

void mimik_normals(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(geometry::vertex_normals(target().vertices_mm, target().triangles));
}
void pcl_normals(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(peers::normals_with_pcl(target().vertices_mm, 9));
}

const auto& scan() {
    static const auto made = bench::make_scan(0.0);
    return made;
}

void mimik_cleaning(benchmark::State& state) {
    base::set_thread_count(1);
    for (auto _ : state) benchmark::DoNotOptimize(preprocessing::clean(scan()));
}
void pcl_cleaning(benchmark::State& state) {
    preprocessing::require_pcl_cleaning();
    for (auto _ : state) benchmark::DoNotOptimize(preprocessing::clean_with_pcl(scan()));
}

BENCHMARK(mimik_rigid_alignment)->Unit(benchmark::kMillisecond);
BENCHMARK(pcl_rigid_alignment)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_normals)->Unit(benchmark::kMillisecond);
BENCHMARK(pcl_normals)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_cleaning)->Unit(benchmark::kMillisecond);
BENCHMARK(pcl_cleaning)->Unit(benchmark::kMillisecond);

}  // namespace
