#include "preprocessing/rigid_alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::Transform;
using geometry::Vector;

void RigidAlignmentOptions::check() const {
    if (max_iterations < 1) throw InputError(fmt::format("max_iterations is {}; give 1 or more", max_iterations));
    if (!(trim > 0 && trim <= 1)) throw InputError(fmt::format("trim is {}; give a share above 0 and up to 1", trim));
    if (!(max_distance_mm > 0))
        throw InputError(fmt::format("max_distance_mm is {}; give more than 0", max_distance_mm));
    if (max_points < 100) throw InputError(fmt::format("max_points is {}; give 100 or more", max_points));
}

namespace {

constexpr double coarse_slack = 5.0;  // steps end so many times sooner while few of the points take part

struct Pair {
    Point moved_mm;
    Point target_mm;
    Vector normal;
    double distance_mm;
    double weight;
};

/// The `kept` closest pairs in the order they came; of equally close ones the first.
void trim_pairs(std::vector<Pair>& pairs, std::size_t kept) {
    if (kept == pairs.size()) return;
    std::vector<double> distances(pairs.size());
    std::transform(pairs.begin(), pairs.end(), distances.begin(), [](const Pair& pair) { return pair.distance_mm; });
    const auto last = distances.begin() + static_cast<std::ptrdiff_t>(kept - 1);
    std::nth_element(distances.begin(), last, distances.end());
    const double limit_mm = *last;
    auto ties = static_cast<std::size_t>(std::count(distances.begin(), last + 1, limit_mm));
    std::erase_if(pairs, [&](const Pair& pair) {
        if (pair.distance_mm == limit_mm && ties > 0) {
            --ties;
            return false;
        }
        return pair.distance_mm >= limit_mm;
    });
}

/// Evenly through the list, no more than `most`.
template <typename Value>
std::vector<Value> thinned(std::span<const Value> values, std::size_t most) {
    const std::size_t stride = std::max<std::size_t>(1, (values.size() + most - 1) / most);
    std::vector<Value> some;
    for (std::size_t k = 0; k < values.size(); k += stride) some.push_back(values[k]);
    return some;
}

/// Small rotation w and shift t about the centroid c of the pairs.
struct Step {
    Point centre = Point::Zero();
    Eigen::Matrix<double, 6, 1> rotation_and_shift;
    double rms_mm = 0;

    [[nodiscard]] double angle_rad() const { return rotation_and_shift.head<3>().norm(); }
    [[nodiscard]] double shift_mm() const { return rotation_and_shift.tail<3>().norm(); }
    [[nodiscard]] Eigen::Isometry3d transform() const {
        const Vector rotation = rotation_and_shift.head<3>();
        const double angle = rotation.norm();
        const Eigen::AngleAxisd turn(angle, angle > 0 ? Vector(rotation / angle) : Vector(Vector::UnitX()));
        return Eigen::Translation3d(centre + rotation_and_shift.tail<3>()) * turn * Eigen::Translation3d(-centre);
    }
};

/// Minimises the weighted sum of (n . (p + w x (p - c) + t - q))^2.
Step best_step(const std::vector<Pair>& pairs) {
    Step step;
    double total = 0;
    for (const auto& pair : pairs) {
        step.centre += pair.weight * pair.moved_mm;
        total += pair.weight;
    }
    if (!(total > 0)) throw NumericalError("rigid alignment: every pair that is left has weight 0");
    step.centre /= total;
    Eigen::Matrix<double, 6, 6> normal_matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right_side = Eigen::Matrix<double, 6, 1>::Zero();
    double squared = 0;
    for (const auto& pair : pairs) {
        Eigen::Matrix<double, 6, 1> row;
        row << (pair.moved_mm - step.centre).cross(pair.normal), pair.normal;
        const double residual = pair.normal.dot(pair.moved_mm - pair.target_mm);
        normal_matrix += pair.weight * row * row.transpose();
        right_side -= pair.weight * residual * row;
        squared += pair.weight * residual * residual;
    }
    step.rms_mm = std::sqrt(squared / total);
    step.rotation_and_shift = normal_matrix.ldlt().solve(right_side);
    if (!step.rotation_and_shift.allFinite()) throw NumericalError("rigid alignment: the points determine no rotation");
    return step;
}

void check_weights(std::span<const double> weights, std::size_t points) {
    if (!weights.empty() && weights.size() != points)
        throw InputError(fmt::format("{} for {} points; give one per point, or none",
                                     base::counted(weights.size(), "weight"), points));
    for (const double weight : weights)
        if (!(weight >= 0) || !std::isfinite(weight))
            throw InputError(fmt::format("a weight is {}; give 0 or more", weight));
}

/// Most of the way goes with a few of the points; all that may take part decide where it ends.
class Alignment {
public:
    Alignment(std::span<const Point> source_mm, const geometry::SurfaceIndex& target, const Transform& start,
              const RigidAlignmentOptions& options, std::span<const double> weights)
        : source_mm_(source_mm), weights_(weights), target_(target), options_(options) {
        result_.target_from_source = start;
        coarse_ =
            options.coarse_points > 0 && 2 * options.coarse_points <= std::min(source_mm.size(), options.max_points);
        take(coarse_ ? options.coarse_points : options.max_points);
    }

    RigidAlignment run() {
        while (result_.iterations < options_.max_iterations && !result_.converged) {
            ++result_.iterations;
            find_pairs();
            const auto kept = static_cast<std::size_t>(std::ceil(options_.trim * static_cast<double>(pairs_.size())));
            if (coarse_ && kept < fewest_pairs) {
                take_all();
                continue;
            }
            if (kept < fewest_pairs)
                throw NumericalError(
                    fmt::format("rigid alignment: only {} of {} points found a partner on the other scan; "
                                "30 are needed (is this the same face, in the same unit?)",
                                kept, points_.size()));
            trim_pairs(pairs_, kept);
            result_.pairs_used = kept;
            go(best_step(pairs_));
        }
        return result_;
    }

private:
    static constexpr std::size_t fewest_pairs = 30;

    void take(std::size_t most) {
        points_ = thinned<Point>(source_mm_, most);
        weight_of_ = thinned<double>(weights_, most);
        moved_.resize(points_.size());
        near_.clear();
    }
    void take_all() {
        take(options_.max_points);
        coarse_ = false;
    }

    void find_pairs() {
        const auto vertices = target_.vertices_mm();
        const auto triangles = target_.triangles();
        std::transform(points_.begin(), points_.end(), moved_.begin(),
                       [&](const Point& p) -> Point { return result_.target_from_source * p; });
        const auto hits = target_.closest(moved_, near_);
        near_.resize(hits.size());
        pairs_.clear();
        result_.border_hits = 0;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            near_[k] = hits[k].triangle;
            if (hits[k].distance_mm > options_.max_distance_mm) continue;
            if (target_.on_border(hits[k])) {
                ++result_.border_hits;
                continue;
            }
            const auto& t = triangles[hits[k].triangle];
            const Vector normal = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]).normalized();
            pairs_.push_back({moved_[k], hits[k].position_mm, normal, hits[k].distance_mm,
                              weight_of_.empty() ? 1.0 : weight_of_[k]});
        }
    }

    void go(const Step& step) {
        result_.rms_mm = step.rms_mm;
        result_.target_from_source = step.transform() * result_.target_from_source;
        const double slack = coarse_ ? coarse_slack : 1.0;
        const bool settled = step.angle_rad() * 180.0 / std::numbers::pi < slack * options_.stop_rotation_deg &&
                             step.shift_mm() < slack * options_.stop_shift_mm;
        if (settled && coarse_)
            take_all();
        else
            result_.converged = settled;
    }

    std::span<const Point> source_mm_;
    std::span<const double> weights_;
    const geometry::SurfaceIndex& target_;
    const RigidAlignmentOptions& options_;
    std::vector<Point> points_, moved_;
    std::vector<double> weight_of_;
    std::vector<std::uint32_t> near_;  // where each point was last: it moves little from step to step
    std::vector<Pair> pairs_;
    RigidAlignment result_;
    bool coarse_ = false;
};

}  // namespace

RigidAlignment align_rigidly(std::span<const Point> source_mm, const geometry::SurfaceIndex& target,
                             const Transform& start, const RigidAlignmentOptions& options,
                             std::span<const double> weights) {
    options.check();
    check_weights(weights, source_mm.size());
    return Alignment(source_mm, target, start, options, weights).run();
}

}  // namespace mimik::preprocessing
