#include "preprocessing/nonrigid_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/statistics.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::Triangle;
using geometry::Vector;
using Sparse = Eigen::SparseMatrix<double>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

FitTarget::FitTarget(std::span<const Point> vertices_mm, std::span<const Triangle> triangles)
    : surface_(vertices_mm, triangles), normals_(geometry::vertex_normals(vertices_mm, triangles)) {}

Vector FitTarget::normal(const geometry::SurfacePoint& at) const {
    const auto& corners = surface_.triangles()[at.triangle];
    Vector sum = Vector::Zero();
    for (std::size_t k = 0; k < 3; ++k) sum += at.barycentric[static_cast<Eigen::Index>(k)] * normals_[corners[k]];
    const double length = sum.norm();
    return length > 0 ? Vector(sum / length) : Vector(Vector::Zero());
}

void NonrigidFitOptions::check() const {
    if (!(first_smoothness > 0 && last_smoothness > 0))
        throw InputError(
            fmt::format("smoothness goes from {} to {}; give weights above 0", first_smoothness, last_smoothness));
    if (stages < 1) throw InputError(fmt::format("stages is {}; give 1 or more", stages));
    if (steps < 1) throw InputError(fmt::format("steps is {}; give 1 or more", steps));
    if (!(point_share >= 0 && point_share <= 1))
        throw InputError(fmt::format("point_share is {}; give a share from 0 to 1", point_share));
    if (!(mark_weight >= 0)) throw InputError(fmt::format("mark_weight is {}; give 0 or more", mark_weight));
    if (!(least_cosine >= -1 && least_cosine < 1))
        throw InputError(fmt::format("least_cosine is {}; give -1 or more, below 1", least_cosine));
    if (!(most_mm > 0)) throw InputError(fmt::format("most_mm is {}; give more than 0", most_mm));
    if (!(least_scale_mm > 0)) throw InputError(fmt::format("least_scale_mm is {}; give more than 0", least_scale_mm));
    if (!(bend_mm >= 0)) throw InputError(fmt::format("bend_mm is {}; give 0 or more", bend_mm));
    if (!(stillness >= 0)) throw InputError(fmt::format("stillness is {}; give 0 or more", stillness));
}

double NonrigidFitOptions::smoothness(int stage) const {
    if (stages == 1) return last_smoothness;
    return first_smoothness * std::pow(last_smoothness / first_smoothness, static_cast<double>(stage) / (stages - 1));
}

struct NonrigidFitter::Impl {
    std::vector<Triangle> triangles;
    std::vector<std::array<std::uint32_t, 2>> edges;  // the lower vertex first, in ascending order
    std::vector<std::vector<std::uint32_t>> neighbours;
    std::vector<double> area;  // per vertex, in 9 mm^2
};

namespace {

constexpr double vertex_area_mm2 = 9.0;  // a vertex of a mesh with 3 mm between vertices weighs 1

/// One fit at work.
class Fit {
public:
    Fit(const NonrigidFitter::Impl& mesh, std::span<const Point> start_mm, const FitTarget& target,
        std::span<const FitMark> marks, const NonrigidFitOptions& options, const FitHints& hints)
        : mesh_(mesh),
          start_mm_(start_mm),
          target_(target),
          marks_(marks),
          options_(options),
          hints_(hints),
          now_(start_mm.begin(), start_mm.end()),
          correction_(Columns::Zero(static_cast<Eigen::Index>(start_mm.size()), 3)),
          pairs_(start_mm.size()) {}

    NonrigidFit run() {
        for (int stage = 0; stage < options_.stages; ++stage)
            for (int step = 0; step < options_.steps; ++step) {
                find_pairs();
                solve(options_.smoothness(stage));
            }
        find_pairs();
        return result();
    }

private:
    struct Pair {
        Point target_mm = Point::Zero();
        Vector normal = Vector::Zero();
        double weight = 0.0;
        double distance_mm = std::numeric_limits<double>::infinity();
        bool sound = false;
    };

    void find_pairs() {
        const auto normals = geometry::vertex_normals(now_, mesh_.triangles);
        const auto hits = target_.surface().closest(now_, near_);
        near_.resize(hits.size());
        std::vector<double> distances;
        for (std::size_t v = 0; v < hits.size(); ++v) {
            near_[v] = hits[v].triangle;
            auto& pair = pairs_[v];
            pair.target_mm = hits[v].position_mm;
            pair.normal = target_.normal(hits[v]);
            pair.distance_mm = hits[v].distance_mm;
            pair.sound = hits[v].distance_mm <= options_.most_mm &&
                         (on_rim(v) || !target_.surface().on_border(hits[v])) &&
                         pair.normal.dot(normals[v]) >= options_.least_cosine;
            if (pair.sound) distances.push_back(pair.distance_mm);
        }
        constexpr double scales = 3.0;  // of the median distance: what lies within is hardly weighed down
        const double scale_mm = std::max(options_.least_scale_mm, scales * geometry::upper_median(distances));
        for (std::size_t v = 0; v < pairs_.size(); ++v) {
            auto& pair = pairs_[v];
            const double share = pair.distance_mm / scale_mm;
            pair.weight = pair.sound ? mesh_.area[v] / ((1 + share * share) * (1 + share * share)) : 0.0;
        }
    }

    /// How much a difference of corrections counts: less the larger it is, so that motion may be concentrated.
    [[nodiscard]] double robust(const Vector& difference) const {
        if (options_.bend_mm == 0) return 1.0;
        return 1.0 / std::sqrt(1.0 + difference.squaredNorm() / (options_.bend_mm * options_.bend_mm));
    }
    [[nodiscard]] bool on_rim(std::size_t v) const { return !hints_.on_rim.empty() && hints_.on_rim[v]; }
    [[nodiscard]] double stillness(std::size_t v) const {
        if (hints_.rest_mm.empty()) return 0.0;
        return options_.stillness * mesh_.area[v] * (hints_.stillness.empty() ? 1.0 : hints_.stillness[v]);
    }
    [[nodiscard]] Vector correction(std::uint32_t v) const { return correction_.row(v).transpose(); }

    /// First and second differences of the correction, and stillness: the same for x, y and z.
    void smooth(double smoothness) {
        entries_.clear();
        for (const auto& [a, b] : mesh_.edges) {
            const double weight = smoothness * robust(correction(a) - correction(b));
            entries_.emplace_back(a, a, weight);
            entries_.emplace_back(b, b, weight);
            entries_.emplace_back(b, a, -weight);
        }
        for (std::uint32_t v = 0; v < mesh_.neighbours.size(); ++v) {
            const auto& around = mesh_.neighbours[v];
            if (around.empty()) continue;
            const double share = 1.0 / static_cast<double>(around.size());
            Vector mean = Vector::Zero();
            for (const auto n : around) mean += share * correction(n);
            const double weight = smoothness * robust(correction(v) - mean);
            entries_.emplace_back(v, v, weight);
            for (const auto n : around) {
                entries_.emplace_back(std::max(v, n), std::min(v, n), -weight * share);
                for (const auto m : around)
                    if (m <= n) entries_.emplace_back(n, m, weight * share * share);
            }
        }
        for (std::uint32_t v = 0; v < mesh_.neighbours.size(); ++v) entries_.emplace_back(v, v, 1e-6 + stillness(v));
    }

    /// The data's part of the system: 3 x 3 blocks, and marks that tie three vertices.
    void gather_data() {
        blocks_.assign(now_.size(), Eigen::Matrix3d::Zero());
        right_ = Columns::Zero(correction_.rows(), 3);
        for (std::size_t v = 0; v < now_.size(); ++v) {
            const auto& pair = pairs_[v];
            if (pair.weight > 0) {
                blocks_[v] = pair.weight * ((1 - options_.point_share) * pair.normal * pair.normal.transpose() +
                                            options_.point_share * Eigen::Matrix3d::Identity());
                right_.row(static_cast<Eigen::Index>(v)) += (blocks_[v] * (pair.target_mm - start_mm_[v])).transpose();
            }
            if (!hints_.rest_mm.empty())
                right_.row(static_cast<Eigen::Index>(v)) +=
                    stillness(v) * (hints_.rest_mm[v] - start_mm_[v]).transpose();
        }
        for (const auto& mark : marks_) {
            const double weight = options_.mark_weight * mark.weight;
            Vector miss = mark.target_mm;
            for (Eigen::Index k = 0; k < 3; ++k)
                miss -= mark.weights[k] * start_mm_[mark.corners[static_cast<std::size_t>(k)]];
            for (Eigen::Index k = 0; k < 3; ++k) {
                const auto a = mark.corners[static_cast<std::size_t>(k)];
                right_.row(a) += weight * mark.weights[k] * miss.transpose();
                for (Eigen::Index m = 0; m < 3; ++m) {
                    const auto b = mark.corners[static_cast<std::size_t>(m)];
                    if (b <= a) entries_.emplace_back(a, b, weight * mark.weights[k] * mark.weights[m]);
                }
            }
        }
    }

    void solve(double smoothness) {
        smooth(smoothness);
        gather_data();
        const auto size = correction_.rows();
        Sparse shared(size, size);  // lower triangle; without the blocks
        shared.setFromTriplets(entries_.begin(), entries_.end());
        Sparse scalar = shared;
        for (Eigen::Index v = 0; v < size; ++v)
            scalar.coeffRef(v, v) += blocks_[static_cast<std::size_t>(v)].trace() / 3;
        if (!analysed_) factor_.analyzePattern(scalar);
        analysed_ = true;
        factor_.factorize(scalar);
        if (factor_.info() != Eigen::Success) throw NumericalError("non-rigid fit: the system has no solution");
        conjugate_gradients(shared);
        for (std::size_t v = 0; v < now_.size(); ++v)
            now_[v] = start_mm_[v] + correction(static_cast<std::uint32_t>(v));
    }

    [[nodiscard]] Columns product(const Sparse& shared, const Columns& x) const {
        Columns y = shared.selfadjointView<Eigen::Lower>() * x;
        for (Eigen::Index v = 0; v < x.rows(); ++v)
            y.row(v) += (blocks_[static_cast<std::size_t>(v)] * x.row(v).transpose()).transpose();
        return y;
    }

    /// The blocks tie x, y and z; the factor of their mean makes the rest a matter of a few steps.
    void conjugate_gradients(const Sparse& shared) {
        constexpr int most_steps = 30;
        constexpr double tolerance = 1e-4;
        Columns residual = right_ - product(shared, correction_);
        const double enough = tolerance * tolerance * right_.squaredNorm();
        Columns direction = factor_.solve(residual);
        double size = residual.cwiseProduct(direction).sum();
        for (int step = 0; step < most_steps && residual.squaredNorm() > enough; ++step) {
            const Columns image = product(shared, direction);
            const double way = size / direction.cwiseProduct(image).sum();
            correction_ += way * direction;
            residual -= way * image;
            const Columns conditioned = factor_.solve(residual);
            const double next = residual.cwiseProduct(conditioned).sum();
            direction = conditioned + (next / size) * direction;
            size = next;
        }
        if (!correction_.allFinite()) throw NumericalError("non-rigid fit: the system has no solution");
    }

    NonrigidFit result() {
        NonrigidFit fit;
        double squares = 0;
        std::size_t matched = 0;
        for (const auto& pair : pairs_) {
            fit.matched.push_back(pair.sound ? 1 : 0);
            fit.residual_mm.push_back(pair.distance_mm);
            if (!pair.sound) continue;
            ++matched;
            squares += pair.distance_mm * pair.distance_mm;
        }
        fit.vertices_mm = std::move(now_);
        fit.matched_share = pairs_.empty() ? 0.0 : static_cast<double>(matched) / static_cast<double>(pairs_.size());
        fit.residual_rms_mm = matched == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(matched));
        return fit;
    }

    const NonrigidFitter::Impl& mesh_;
    std::span<const Point> start_mm_;
    const FitTarget& target_;
    std::span<const FitMark> marks_;
    const NonrigidFitOptions& options_;
    const FitHints& hints_;
    std::vector<Point> now_;
    Columns correction_, right_;
    std::vector<Pair> pairs_;
    std::vector<std::uint32_t> near_;
    std::vector<Eigen::Triplet<double>> entries_;
    std::vector<Eigen::Matrix3d> blocks_;
    Eigen::SimplicialLLT<Sparse> factor_;
    bool analysed_ = false;
};

}  // namespace

NonrigidFitter::NonrigidFitter(std::span<const Point> vertices_mm, std::span<const Triangle> triangles) {
    Impl impl;
    impl.triangles.assign(triangles.begin(), triangles.end());
    impl.area.assign(vertices_mm.size(), 0.0);
    impl.neighbours.resize(vertices_mm.size());
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const auto& t : triangles) {
        const double area =
            0.5 * (vertices_mm[t[1]] - vertices_mm[t[0]]).cross(vertices_mm[t[2]] - vertices_mm[t[0]]).norm();
        for (std::size_t k = 0; k < 3; ++k) {
            impl.area[t[k]] += area / 3 / vertex_area_mm2;
            edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
        }
    }
    impl.edges.assign(edges.begin(), edges.end());
    for (const auto& [a, b] : impl.edges) {
        impl.neighbours[a].push_back(b);
        impl.neighbours[b].push_back(a);
    }
    impl_ = std::make_unique<const Impl>(std::move(impl));
}
NonrigidFitter::~NonrigidFitter() = default;
NonrigidFitter::NonrigidFitter(NonrigidFitter&&) noexcept = default;

NonrigidFit NonrigidFitter::fit(std::span<const Point> start_mm, const FitTarget& target,
                                std::span<const FitMark> marks, const NonrigidFitOptions& options,
                                const FitHints& hints) const {
    options.check();
    const auto fits = [&](std::size_t count) { return count == 0 || count == impl_->area.size(); };
    if (start_mm.size() != impl_->area.size() || !fits(hints.rest_mm.size()) || !fits(hints.stillness.size()) ||
        !fits(hints.on_rim.size()))
        throw InputError(fmt::format("{} places to start, hints for {}, {} and {} for {} vertices; give one each",
                                     start_mm.size(), hints.rest_mm.size(), hints.stillness.size(), hints.on_rim.size(),
                                     impl_->area.size()));
    return Fit(*impl_, start_mm, target, marks, options, hints).run();
}

}  // namespace mimik::preprocessing
