#include "geometry/expression_cloning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::geometry {

void ExpressionCloningOptions::check() const {
    if (rings < 1) throw InputError(fmt::format("rings is {}; give 1 or more", rings));
    if (!(most_scale >= 1 && std::isfinite(most_scale)))
        throw InputError(fmt::format("most_scale is {}; give 1 or more", most_scale));
    if (!(flat_share >= 0 && flat_share < 1))
        throw InputError(fmt::format("flat_share is {}; give 0 or more, below 1", flat_share));
}

namespace {

/// Corners of the triangles at each vertex but itself, in ascending order.
std::vector<std::vector<std::uint32_t>> neighbours(std::size_t vertices, std::span<const Triangle> triangles) {
    std::vector<std::vector<std::uint32_t>> around(vertices);
    for (const auto& triangle : triangles)
        for (const auto v : triangle)
            for (const auto other : triangle)
                if (other != v) around[v].push_back(other);
    for (auto& ring : around) {
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    }
    return around;
}

/// The vertices that so many edges or fewer lead to, but for the vertex itself.
std::vector<std::uint32_t> surroundings(const std::vector<std::vector<std::uint32_t>>& around, std::uint32_t v,
                                        int rings, std::vector<std::uint32_t>& seen) {
    std::vector<std::uint32_t> found = {v};
    seen[v] = v;
    for (std::size_t first = 0; rings > 0; --rings)
        for (const std::size_t last = found.size(); first < last; ++first)
            for (const auto other : around[found[first]])
                if (std::exchange(seen[other], v) != v) found.push_back(other);
    found.erase(found.begin());
    return found;
}

Vector mean_normal(std::span<const Vector> normals, std::uint32_t v, std::span<const std::uint32_t> ring) {
    Vector sum = normals[v];
    for (const auto other : ring) sum += normals[other];
    return sum.normalized();
}

/// The vertex whose direction is the surest: the farthest in the source's tangent plane.
std::uint32_t farthest(std::span<const Point> vertices, std::uint32_t v, const Vector& normal,
                       std::span<const std::uint32_t> ring) {
    std::uint32_t longest = v;
    double length2 = 0;
    for (const auto other : ring) {
        const double across2 = normal.cross(vertices[other] - vertices[v]).squaredNorm();
        if (across2 > length2) {
            longest = other;
            length2 = across2;
        }
    }
    return longest;
}

/// Columns: the normal, the edge within the tangent plane, their product. Empty where they are no axes.
std::optional<Eigen::Matrix3d> local_axes(const Vector& normal, const Vector& edge) {
    const Vector tangent = edge - normal.dot(edge) * normal;
    const double length = tangent.norm();
    if (!(normal.squaredNorm() > 0.5) || !(length > 0) || !std::isfinite(length)) return std::nullopt;
    Eigen::Matrix3d axes;
    axes << normal, tangent / length, normal.cross(tangent / length);
    return axes;
}

/// Lengths of the box about a vertex and its ring, along the axes.
Vector box(std::span<const Point> vertices, std::uint32_t v, std::span<const std::uint32_t> ring,
           const Eigen::Matrix3d& axes) {
    Vector low = Vector::Zero(), high = Vector::Zero();
    for (const auto other : ring) {
        const Vector local = axes.transpose() * (vertices[other] - vertices[v]);
        low = low.cwiseMin(local);
        high = high.cwiseMax(local);
    }
    return high - low;
}

/// How much larger a box is along each axis.
Vector scales(const Vector& source, const Vector& target, const ExpressionCloningOptions& options) {
    Vector ratio = Vector::Ones();
    double sum = 0, count = 0;
    std::array<bool, 3> flat{};
    for (Eigen::Index k = 0; k < 3; ++k) {
        flat[static_cast<std::size_t>(k)] = !(source[k] > options.flat_share * source.maxCoeff()) ||
                                            !(target[k] > options.flat_share * target.maxCoeff());
        if (flat[static_cast<std::size_t>(k)]) continue;
        ratio[k] = target[k] / source[k];
        sum += ratio[k];
        ++count;
    }
    for (Eigen::Index k = 0; k < 3; ++k) {
        if (flat[static_cast<std::size_t>(k)] && count > 0) ratio[k] = sum / count;
        ratio[k] = std::clamp(ratio[k], 1 / options.most_scale, options.most_scale);
    }
    return ratio;
}

}  // namespace

std::vector<Vector> cloned_motion(std::span<const Point> source_mm, std::span<const Vector> motion_mm,
                                  std::span<const Point> target_mm, std::span<const Triangle> triangles,
                                  const ExpressionCloningOptions& options) {
    options.check();
    if (source_mm.size() != target_mm.size() || source_mm.size() != motion_mm.size())
        throw InputError(
            fmt::format("expression cloning: {} vertices, {} motions and {} vertices of the target; give "
                        "as many of each",
                        source_mm.size(), motion_mm.size(), target_mm.size()));
    const auto around = neighbours(source_mm.size(), triangles);
    const auto source_normals = vertex_normals(source_mm, triangles);
    const auto target_normals = vertex_normals(target_mm, triangles);
    std::vector<Vector> cloned(motion_mm.begin(), motion_mm.end());
    std::vector<std::uint32_t> seen(cloned.size(), std::numeric_limits<std::uint32_t>::max());
    for (std::uint32_t v = 0; v < cloned.size(); ++v) {
        const auto ring = surroundings(around, v, options.rings, seen);
        const auto source_normal = mean_normal(source_normals, v, ring);
        const auto edge = farthest(source_mm, v, source_normal, ring);
        const auto from = local_axes(source_normal, source_mm[edge] - source_mm[v]);
        const auto to = local_axes(mean_normal(target_normals, v, ring), target_mm[edge] - target_mm[v]);
        if (!from || !to) continue;
        const Vector scale = scales(box(source_mm, v, ring, *from), box(target_mm, v, ring, *to), options);
        cloned[v] = *to * scale.cwiseProduct(from->transpose() * motion_mm[v]);
    }
    return cloned;
}

}  // namespace mimik::geometry
