#include "animation/planar_bones.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"

namespace mimik::animation {

using geometry::Point;
using geometry::Triangle;
using geometry::Vector;
using Region = PlanarBones::Region;

void PlanarBonesOptions::check() const {
    if (!std::isfinite(radius_share) || radius_share <= 0)
        throw InputError(fmt::format("radius_share is {}; give more than 0", radius_share));
}

namespace {

constexpr std::size_t vertices_a_piece = 512;

std::size_t place(Region region) { return static_cast<std::size_t>(region); }
Region edge(std::size_t i) { return static_cast<Region>(1 + i); }
Region corner(std::size_t i) { return static_cast<Region>(4 + i); }
/// The corner that a region's frame stands on.
std::size_t origin(Region region) { return region == Region::face ? 0 : (place(region) - 1) % 3; }
bool is_corner(Region region) { return place(region) >= 4; }

struct Seen {
    Region region = Region::face;
    double distance_mm = 0;
};

/// The nearest feature of a triangle, which the projection on its plane decides, and the distance to it.
Seen seen_from(const std::array<Point, 3>& corners, const Vector& normal, const Point& vertex) {
    const double height = normal.dot(vertex - corners[0]);
    const Point foot = vertex - height * normal;
    Seen nearest;
    double least = std::numeric_limits<double>::infinity();
    bool outside = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector along = corners[(i + 1) % 3] - corners[i], from = foot - corners[i];
        const double length = along.norm();
        if (along.cross(normal).dot(from) <= 0) continue;  // on the inner side of this edge
        outside = true;
        const double c = from.dot(along) / length;  // Eq. 6
        Region region = edge(i);
        double distance = std::sqrt(std::max(0.0, from.squaredNorm() - c * c));
        if (c < 0 || c > length) {  // Eqs 4 and 5
            const auto at = c < 0 ? i : (i + 1) % 3;
            region = corner(at);
            distance = (foot - corners[at]).norm();
        }
        if (distance >= least) continue;
        least = distance;
        nearest = {region, std::hypot(distance, height)};
    }
    if (!outside) return {Region::face, std::abs(height)};
    return nearest;
}

double cosine_weight(double distance_mm, double radius_mm) {  // Eq. 12
    return distance_mm < radius_mm ? 0.5 * (1 + std::cos(distance_mm / radius_mm * std::numbers::pi)) : 0;
}

double fade(double largest_weight) {
    if (largest_weight >= 0.5) return 1;
    const double sine = std::sin(std::numbers::pi * largest_weight);
    return sine * sine;
}

void check_input(std::span<const Point> control_mm, std::span<const Triangle> triangles,
                 std::span<const Point> vertices_mm, const BoneMasks& masks) {
    const auto finite = [](const Point& p) { return p.allFinite(); };
    if (!std::all_of(control_mm.begin(), control_mm.end(), finite) ||
        !std::all_of(vertices_mm.begin(), vertices_mm.end(), finite))
        throw InputError("planar bones: a coordinate is not finite; leave that vertex or marker out");
    for (const auto& triangle : triangles) {
        for (const auto corner_index : triangle)
            if (corner_index >= control_mm.size())
                throw InputError(fmt::format("planar bones: a triangle has corner {}, and there are {}", corner_index,
                                             base::counted(control_mm.size(), "control point")));
        const Vector a = control_mm[triangle[1]] - control_mm[triangle[0]];
        const Vector b = control_mm[triangle[2]] - control_mm[triangle[0]];
        if (!(a.cross(b).norm() > 1e-9 * std::max(a.squaredNorm(), b.squaredNorm())))
            throw InputError(fmt::format("planar bones: the triangle {}, {}, {} has no area at rest; leave it out",
                                         triangle[0], triangle[1], triangle[2]));
    }
    if (masks.of_bone.empty() && masks.of_vertex.empty()) return;
    if (masks.of_bone.size() != triangles.size() || masks.of_vertex.size() != vertices_mm.size())
        throw InputError(fmt::format(
            "planar bones: masks for {} and {}, and there are {} and {}", base::counted(masks.of_bone.size(), "bone"),
            base::counted(masks.of_vertex.size(), "vertex", "vertices"), triangles.size(), vertices_mm.size()));
}

}  // namespace

PlanarBones::Bone PlanarBones::bone(std::span<const Point> control_mm, const Triangle& triangle) {
    Bone one;
    for (std::size_t i = 0; i < 3; ++i) one.corners[i] = control_mm[triangle[i]];
    const Vector first = one.corners[1] - one.corners[0], second = one.corners[2] - one.corners[0];
    const Vector normal = first.cross(second).normalized();  // stays zero where the triangle has collapsed
    one.frames[0] << first, second, normal;                  // Eq. 2
    std::array<Vector, 3> along, out;
    for (std::size_t i = 0; i < 3; ++i) {
        along[i] = one.corners[(i + 1) % 3] - one.corners[i];
        out[i] = along[i].cross(normal).normalized();
    }
    for (std::size_t i = 0; i < 3; ++i) {
        one.frames[place(edge(i))] << along[i], out[i], normal;            // Eq. 7
        one.frames[place(corner(i))] << out[i], out[(i + 2) % 3], normal;  // Eq. 8
    }
    return one;
}

void PlanarBones::find_radii(std::span<const Point> control_mm, double share) {
    std::vector<double> shortest(control_mm.size(), std::numeric_limits<double>::infinity());
    for (const auto& triangle : triangles_)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto a = triangle[i], b = triangle[(i + 1) % 3];
            const double length = (control_mm[a] - control_mm[b]).norm();
            shortest[a] = std::min(shortest[a], length);
            shortest[b] = std::min(shortest[b], length);
        }
    for (const auto& triangle : triangles_)
        radii_mm_.push_back(share * std::min({shortest[triangle[0]], shortest[triangle[1]], shortest[triangle[2]]}));
}

void PlanarBones::bind(const std::vector<Bone>& bones, const Point& vertex_mm, std::uint32_t mask,
                       const BoneMasks& masks) {
    double sum = 0, largest = 0;
    const auto begin = influences_.size();
    for (std::size_t j = 0; j < bones.size(); ++j) {
        if (!masks.of_bone.empty() && (masks.of_bone[j] & mask) == 0) continue;
        const auto seen = seen_from(bones[j].corners, bones[j].frames[0].col(2), vertex_mm);
        const double weight = cosine_weight(seen.distance_mm, radii_mm_[j]);
        if (!(weight > 0)) continue;
        Influence one;
        one.bone = static_cast<std::uint32_t>(j);
        one.region = seen.region;
        one.weight = weight;
        const Vector from = vertex_mm - bones[j].corners[origin(seen.region)];
        one.local = bones[j].frames[place(seen.region)].partialPivLu().solve(from);
        const Vector normal = bones[j].frames[0].col(2);
        one.from_corner_mm = (from - normal.dot(from) * normal).norm();
        sum += weight;
        largest = std::max(largest, weight);
        influences_.push_back(one);
    }
    for (auto k = begin; k < influences_.size(); ++k) influences_[k].weight *= fade(largest) / sum;
    first_.push_back(influences_.size());
}

PlanarBones::PlanarBones(std::span<const Point> control_mm, std::span<const Triangle> triangles,
                         std::span<const Point> vertices_mm, const PlanarBonesOptions& options, const BoneMasks& masks)
    : triangles_(triangles.begin(), triangles.end()),
      controls_(control_mm.size()),
      vertices_mm_(vertices_mm.begin(), vertices_mm.end()) {
    options.check();
    check_input(control_mm, triangles, vertices_mm, masks);
    find_radii(control_mm, options.radius_share);
    std::vector<Bone> bones;
    for (const auto& triangle : triangles_) bones.push_back(bone(control_mm, triangle));
    for (std::size_t v = 0; v < vertices_mm.size(); ++v)
        bind(bones, vertices_mm[v], masks.of_vertex.empty() ? 0 : masks.of_vertex[v], masks);
}

void PlanarBones::displace(std::span<const Point> control_mm, std::span<Vector> displacement_mm) const {
    if (control_mm.size() != controls_ || displacement_mm.size() != vertices())
        throw InputError(fmt::format("planar bones: {} and room for {}, and there are {} and {}",
                                     base::counted(control_mm.size(), "control point"),
                                     base::counted(displacement_mm.size(), "displacement"), controls_, vertices()));
    std::vector<Bone> bones;
    bones.reserve(triangles_.size());
    for (const auto& triangle : triangles_) bones.push_back(bone(control_mm, triangle));
    base::parallel_for(vertices(), vertices_a_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Vector moved = Vector::Zero();
            for (auto k = first_[v]; k < first_[v + 1]; ++k) {
                const auto& one = influences_[k];
                const auto& its = bones[one.bone];
                const auto& frame = its.frames[place(one.region)];
                Vector from = frame * one.local;
                if (is_corner(one.region)) {  // Eq. 10: the distance from the corner in the plane is kept
                    const Vector in_plane = frame.leftCols<2>() * one.local.head<2>();
                    const double now = in_plane.norm();
                    if (now > 0) from += (one.from_corner_mm / now - 1) * in_plane;
                }
                moved += one.weight * (its.corners[origin(one.region)] + from - vertices_mm_[v]);
            }
            displacement_mm[v] = moved;
        }
    });
}

}  // namespace mimik::animation
