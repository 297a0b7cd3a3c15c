#include <cstdlib>
#include <filesystem>
#include <random>

#include <benchmark/benchmark.h>

#include "animation/animate.h"
#include "base/parallel.h"
#include "database/bnt.h"
#include "database/bosphorus_landmarks.h"
#include "evaluation/surface_distance.h"
#include "preprocessing/neutral_alignment.h"
#include "preprocessing/normalisation.h"
#include "preprocessing/preprocess_scan.h"
#include "preprocessing/stable_region.h"
#include "tests/support/analytic_workspace.h"
#include "tests/support/expressions.h"

// What a researcher waits for: a scan from its files to a normalised grid, and one transfer with its evaluation in both
// directions. Faces in closed form with a scanner's lattice, noise and size; no peer does the same job.

namespace {

using namespace mimik;
using preprocessing::Face;

constexpr double step_mm = 0.77;   // 35,000 points on the oval
constexpr double noise_mm = 0.15;  // of a structured-light scanner, as the synthetic databases have it
constexpr std::size_t batch = 8;   // jobs at once where threads are compared

/// Two subjects, neutral and AU 12, as .bnt and .lm3 files.
class Files {
public:
    Files() {
        std::string pattern = (std::filesystem::temp_directory_path() / "mimik-bench-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder for the benchmark");
        folder_ = pattern;
        neutral = write({1.0, 0.0}, {"bs000", "N", "N", 0}, 0.05);
        smiling = write({1.0, 6.0}, {"bs000", "LFAU", "12", 0}, -0.04);
        other_neutral = write({1.06, 0.0}, {"bs001", "N", "N", 0}, -0.02);
        other_smiling = write({1.06, 5.0}, {"bs001", "LFAU", "12", 0}, 0.03);
    }
    ~Files() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    Files(const Files&) = delete;
    Files& operator=(const Files&) = delete;

    [[nodiscard]] std::filesystem::path output(std::size_t k) const { return folder_ / ("face" + std::to_string(k)); }
    database::ScanEntry neutral, smiling, other_neutral, other_smiling;

private:
    database::ScanEntry write(const test::AnalyticFace& shape, const database::ScanId& id, double turn) {
        const geometry::Transform pose(Eigen::Translation3d(3, -2, 10) *
                                       Eigen::AngleAxisd(turn, geometry::Vector::UnitY()));
        auto scan = shape.scan(step_mm);
        std::mt19937_64 engine(scan.points_mm.size() + static_cast<std::size_t>(1e3 * (1 + turn)));
        for (auto& p : scan.points_mm)
            if (p.allFinite()) {
                p.z() += noise_mm * (2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0);
                p = pose * p;
            }
        database::ScanEntry entry;
        entry.id = id;
        entry.scan_file = folder_ / (id.name() + ".bnt");
        entry.landmarks_file = folder_ / (id.name() + ".lm3");
        database::write_bnt(entry.scan_file, database::to_bnt(scan));
        database::write_lm3(entry.landmarks_file,
                            database::to_bosphorus_labels(geometry::transformed(shape.landmarks(), pose)));
        return entry;
    }
    std::filesystem::path folder_;
};

const Files& files() {
    static const Files made;
    return made;
}

const preprocessing::AverageFace& average() {
    static const auto made = test::analytic_average();
    return made;
}

Face neutral_face(const database::ScanEntry& entry) {
    Face face = preprocessing::preprocess_scan(database::load(entry), {});
    face.average_from_scan = preprocessing::similarity_normalisation(face.landmarks, average().landmarks);
    face.average_from_scan_affine = preprocessing::affine_normalisation(face.snapped_landmarks, average().landmarks);
    return face;
}

void tie(Face& face, const Face& neutral) {
    const auto stable = preprocessing::stable_vertices(facs::builtin_catalogue(), face.id.expression(), neutral);
    preprocessing::align_to_neutral(face, neutral, stable);
    face.average_from_scan = neutral.average_from_scan * face.neutral_from_scan;
    face.average_from_scan_affine = preprocessing::affine_normalisation(face.snapped_landmarks, average().landmarks);
}

Face expressive_face(const database::ScanEntry& entry, const Face& neutral) {
    Face face = preprocessing::preprocess_scan(database::load(entry), {});
    tie(face, neutral);
    return face;
}

/// Both subjects preprocessed; the second is the target.
struct Faces {
    Face neutral = neutral_face(files().neutral), smiling = expressive_face(files().smiling, neutral);
    Face target = neutral_face(files().other_neutral), truth = expressive_face(files().other_smiling, target);
};

const Faces& faces() {
    static const Faces made;
    return made;
}

modeling::ExpressionModel measured() {
    return modeling::measure_expression(facs::builtin_catalogue(), test::expression("12"), average(), faces().neutral,
                                        faces().smiling, modeling::ModelOptions::sparse());
}

/// The target's real expressive scan, in the frame of its neutral.
struct RealScan {
    std::vector<geometry::Point> vertices_mm;
    std::vector<std::uint8_t> counts;
    std::optional<geometry::SurfaceIndex> surface;

    explicit RealScan(const Face& face) {
        for (std::size_t v = 0; v < face.grid.size(); ++v) {
            vertices_mm.emplace_back(face.neutral_from_scan * face.grid.vertices_mm[v]);
            counts.push_back(face.grid.measured(v));
        }
        surface.emplace(vertices_mm, geometry::triangles(face.grid, geometry::BridgedVertices::leave_out));
    }
};

double transfer(const animation::PreparedTarget& target, const modeling::ExpressionModel& model, const RealScan& real) {
    const animation::WeightedExpression weighted{&model, 1.0};
    const auto animated = animation::animate(target, std::span(&weighted, 1));
    const auto& grid = faces().target.grid;
    auto moved_mm = grid.vertices_mm;
    for (std::size_t v = 0; v < moved_mm.size(); ++v) moved_mm[v] += animated.field.mm[v];
    const geometry::SurfaceIndex surface(moved_mm, geometry::triangles(grid, geometry::BridgedVertices::leave_out));
    return evaluation::distances_to_surface(moved_mm, *real.surface, target.surface().measured).summary.mean_mm +
           evaluation::distances_to_surface(real.vertices_mm, surface, real.counts).summary.mean_mm;
}

void mimik_scan_read(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(database::load(files().smiling));
}
void mimik_scan_clean_and_grid(benchmark::State& state) {
    const auto loaded = database::load(files().smiling);
    for (auto _ : state) benchmark::DoNotOptimize(preprocessing::preprocess_scan(loaded, {}));
}
void mimik_scan_align_and_normalise(benchmark::State& state) {
    base::set_thread_count(1);
    const auto& neutral = faces().neutral;
    const Face gridded = preprocessing::preprocess_scan(database::load(files().smiling), {});
    for (auto _ : state) {
        Face face = gridded;
        tie(face, neutral);
        benchmark::DoNotOptimize(face);
    }
}
void mimik_scan_write(benchmark::State& state) {
    for (auto _ : state) preprocessing::write_face(files().output(0), faces().smiling);
}
void mimik_scan_from_file_to_normalised_grid(benchmark::State& state) {
    base::set_thread_count(1);
    const auto& neutral = faces().neutral;
    for (auto _ : state) benchmark::DoNotOptimize(expressive_face(files().smiling, neutral));
}
void mimik_eight_scans_threads(benchmark::State& state) {
    const auto& neutral = faces().neutral;
    base::set_thread_count(static_cast<int>(state.range(0)));
    for (auto _ : state)
        base::parallel_for(batch, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k)
                preprocessing::write_face(files().output(k), expressive_face(files().smiling, neutral));
        });
}

void mimik_expression_measured_on_one_source(benchmark::State& state) {
    (void)faces();
    base::set_thread_count(1);
    for (auto _ : state) benchmark::DoNotOptimize(measured());
}
void mimik_target_made_ready(benchmark::State& state) {
    const auto& made = faces();
    base::set_thread_count(1);
    for (auto _ : state) {
        const animation::PreparedTarget target(made.target);
        benchmark::DoNotOptimize(target.normalised(modeling::Normalisation::similarity));
        benchmark::DoNotOptimize(RealScan(made.truth));
    }
}
void mimik_transfer_and_evaluation_both_ways(benchmark::State& state) {
    const animation::PreparedTarget target(faces().target);
    (void)target.normalised(modeling::Normalisation::similarity);
    const RealScan real(faces().truth);
    const auto model = measured();
    base::set_thread_count(1);
    for (auto _ : state) benchmark::DoNotOptimize(transfer(target, model, real));
}
void mimik_eight_transfers_threads(benchmark::State& state) {
    const animation::PreparedTarget target(faces().target);
    (void)target.normalised(modeling::Normalisation::similarity);
    const RealScan real(faces().truth);
    const auto model = measured();
    base::set_thread_count(static_cast<int>(state.range(0)));
    for (auto _ : state)
        base::parallel_for(batch, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) benchmark::DoNotOptimize(transfer(target, model, real));
        });
}

BENCHMARK(mimik_scan_read)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_scan_clean_and_grid)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_scan_align_and_normalise)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_scan_write)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_scan_from_file_to_normalised_grid)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_eight_scans_threads)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(mimik_expression_measured_on_one_source)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_target_made_ready)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_transfer_and_evaluation_both_ways)->Unit(benchmark::kMillisecond);
BENCHMARK(mimik_eight_transfers_threads)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
