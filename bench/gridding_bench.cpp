#include <benchmark/benchmark.h>

#include "bench/bench_scan.h"
#include "bench/peers/gridding_peer.h"
#include "geometry/delaunay.h"
#include "preprocessing/gridding.h"

namespace {

using namespace mimik;

constexpr double jitter_mm = 0.08;  // general position; 0 would be an exact lattice

void mimik_gridding(benchmark::State& state, double jitter, bool use_lattice) {
    const auto scan = bench::make_scan(jitter);
    preprocessing::GriddingOptions options;
    options.use_lattice = use_lattice;
    preprocessing::GriddingReport report;
    for (auto _ : state) benchmark::DoNotOptimize(preprocessing::grid_scan(scan, options, &report));
    state.counters["points"] = static_cast<double>(report.points);
    state.counters["measured"] = static_cast<double>(report.measured);
}

void cgal_gridding(benchmark::State& state, double jitter) {
    const auto scan = bench::make_scan(jitter);
    std::vector<geometry::Point> points;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i)) points.push_back(scan.points_mm[i]);
    const auto grid = preprocessing::grid_scan(scan);
    for (auto _ : state) benchmark::DoNotOptimize(peers::griddata_cgal(points, grid.vertices_mm));
}

std::vector<Eigen::Vector2d> planar_points(double jitter) {
    const auto scan = bench::make_scan(jitter);
    std::vector<Eigen::Vector2d> points;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i)) points.emplace_back(scan.points_mm[i].head<2>());
    return points;
}

void mimik_delaunay(benchmark::State& state, double jitter) {
    const auto points = planar_points(jitter);
    for (auto _ : state) benchmark::DoNotOptimize(geometry::delaunay(points));
}

void cgal_delaunay(benchmark::State& state, double jitter) {
    const auto points = planar_points(jitter);
    if (peers::delaunay_cgal(points).size() != geometry::delaunay(points).size())
        return state.SkipWithError("CGAL makes another number of triangles");
    for (auto _ : state) benchmark::DoNotOptimize(peers::delaunay_cgal(points));
}

// The peers triangulate every point; on an exact lattice Mimik's default splits the scanner's cells instead.
BENCHMARK_CAPTURE(mimik_gridding, general, jitter_mm, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mimik_gridding, general_by_cells, jitter_mm, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mimik_gridding, lattice_every_point, 0.0, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mimik_gridding, lattice, 0.0, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mimik_delaunay, general, jitter_mm)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mimik_delaunay, lattice, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cgal_delaunay, general, jitter_mm)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cgal_delaunay, lattice, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cgal_gridding, general, jitter_mm)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cgal_gridding, lattice, 0.0)->Unit(benchmark::kMillisecond);

}  // namespace
