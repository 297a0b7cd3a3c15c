#include "preprocessing/rigid_alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/errors.h"

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

}  // namespace

RigidAlignment align_rigidly(std::span<const Point> source_mm, const geometry::SurfaceIndex& target,
                             const Transform& start, const RigidAlignmentOptions& options,
                             std::span<const double> weights) {
    options.check();
    if (!weights.empty() && weights.size() != source_mm.size())
        throw InputError(
            fmt::format("{} weights for {} points; give one per point, or none", weights.size(), source_mm.size()));
    for (const double weight : weights)
        if (!(weight >= 0) || !std::isfinite(weight))
            throw InputError(fmt::format("a weight is {}; give 0 or more", weight));
    const auto vertices = target.vertices_mm();
    const auto triangles = target.triangles();
    std::vector<Point> points, moved;
    std::vector<double> weight_of;
    std::vector<std::uint32_t> near;  // where each point was last: it moves little from step to step
    std::vector<Pair> pairs;
    RigidAlignment result;
    result.target_from_source = start;

    // Most of the way goes with a few of the points; all that may take part decide where it ends.
    bool coarse =
        options.coarse_points > 0 && 2 * options.coarse_points <= std::min(source_mm.size(), options.max_points);
    const auto take = [&](std::size_t most) {
        points = thinned<Point>(source_mm, most);
        weight_of = thinned<double>(weights, most);
        moved.resize(points.size());
        near.clear();
    };
    take(coarse ? options.coarse_points : options.max_points);
    while (result.iterations < options.max_iterations && !result.converged) {
        ++result.iterations;
        std::transform(points.begin(), points.end(), moved.begin(),
                       [&](const Point& p) -> Point { return result.target_from_source * p; });
        const auto hits = target.closest(moved, near);
        near.resize(hits.size());
        pairs.clear();
        result.border_hits = 0;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            near[k] = hits[k].triangle;
            if (hits[k].distance_mm > options.max_distance_mm) continue;
            if (target.on_border(hits[k])) {
                ++result.border_hits;
                continue;
            }
            const auto& t = triangles[hits[k].triangle];
            const Vector normal = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]).normalized();
            pairs.push_back(
                {moved[k], hits[k].position_mm, normal, hits[k].distance_mm, weight_of.empty() ? 1.0 : weight_of[k]});
        }
        const auto kept = static_cast<std::size_t>(std::ceil(options.trim * static_cast<double>(pairs.size())));
        if (coarse && kept < 30) {
            take(options.max_points);
            coarse = false;
            continue;
        }
        if (kept < 30)
            throw NumericalError(
                fmt::format("rigid alignment: only {} of {} points found a partner on the other scan; "
                            "30 are needed (is this the same face, in the same unit?)",
                            kept, points.size()));
        trim_pairs(pairs, kept);

        // Small rotation w and shift t about the centroid c: minimise the weighted
        // sum of (n . (p + w x (p - c) + t - q))^2.
        Point centre = Point::Zero();
        double total = 0;
        for (const auto& pair : pairs) {
            centre += pair.weight * pair.moved_mm;
            total += pair.weight;
        }
        if (!(total > 0)) throw NumericalError("rigid alignment: every pair that is left has weight 0");
        centre /= total;
        Eigen::Matrix<double, 6, 6> normal_matrix = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> right_side = Eigen::Matrix<double, 6, 1>::Zero();
        double squared = 0;
        for (const auto& pair : pairs) {
            Eigen::Matrix<double, 6, 1> row;
            row << (pair.moved_mm - centre).cross(pair.normal), pair.normal;
            const double residual = pair.normal.dot(pair.moved_mm - pair.target_mm);
            normal_matrix += pair.weight * row * row.transpose();
            right_side -= pair.weight * residual * row;
            squared += pair.weight * residual * residual;
        }
        result.rms_mm = std::sqrt(squared / total);
        result.pairs_used = kept;
        const Eigen::Matrix<double, 6, 1> step = normal_matrix.ldlt().solve(right_side);
        if (!step.allFinite()) throw NumericalError("rigid alignment: the points determine no rotation");
        const Vector rotation = step.head<3>();
        const double angle = rotation.norm();
        const Eigen::AngleAxisd turn(angle, angle > 0 ? Vector(rotation / angle) : Vector(Vector::UnitX()));
        result.target_from_source = Eigen::Translation3d(centre + step.tail<3>()) * turn *
                                    Eigen::Translation3d(-centre) * result.target_from_source;
        const double slack = coarse ? coarse_slack : 1.0;
        const bool settled = angle * 180.0 / std::numbers::pi < slack * options.stop_rotation_deg &&
                             step.tail<3>().norm() < slack * options.stop_shift_mm;
        if (settled && coarse) {
            take(options.max_points);
            coarse = false;
        } else
            result.converged = settled;
    }
    return result;
}

}  // namespace mimik::preprocessing
