#include "capture/surface_energy.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::capture {

using geometry::Point;
using geometry::Vector;
using Kind = SurfaceEnergy::Term::Kind;

namespace {

/// The product of the normals of the triangles (a, b, c) and (b, a, d), for corners a, b, c, d.
double normals_product(const Point* corners, Vector* gradients) {
    const Point &a = corners[0], &b = corners[1], &c = corners[2], &d = corners[3];
    const Vector across1 = (b - a).cross(c - a), across2 = (a - b).cross(d - b);
    const double length1 = across1.norm(), length2 = across2.norm();
    if (gradients) std::fill_n(gradients, SurfaceEnergy::most_corners, Vector::Zero());
    if (!(length1 > 0 && length2 > 0)) return 0;  // no normal, and nowhere to turn it
    const Vector n1 = across1 / length1, n2 = across2 / length2;
    const double product = n1.dot(n2);
    if (gradients) {
        // A cross product N = p x q changes by dp x q + p x dq, and a normal by the part of dN / |N| across itself.
        const auto add = [&](const Vector& g, std::size_t from, std::size_t p, std::size_t q) {
            const Vector by_p = (corners[q] - corners[from]).cross(g), by_q = g.cross(corners[p] - corners[from]);
            gradients[p] += by_p;
            gradients[q] += by_q;
            gradients[from] -= by_p + by_q;
        };
        add((n2 - product * n1) / length1, 0, 1, 2);
        add((n1 - product * n2) / length2, 1, 0, 3);
    }
    return product;
}

double length(const Point* corners, Vector* gradients) {
    const Vector edge = corners[1] - corners[0];
    const double mm = edge.norm();
    if (gradients) {
        gradients[1] = mm > 0 ? Vector(edge / mm) : Vector(Vector::Zero());
        gradients[0] = -gradients[1];
    }
    return mm;
}

/// What lies beside every edge: the corner opposite in its first and in its second triangle, if there is one.
struct Sides {
    std::uint32_t from = 0, to = 0;  ///< as the first triangle runs
    std::vector<std::uint32_t> opposite;
};
std::map<std::pair<std::uint32_t, std::uint32_t>, Sides> edges_of(std::span<const geometry::Triangle> triangles,
                                                                  std::size_t vertices) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Sides> edges;
    for (const auto& t : triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto a = t[c], b = t[(c + 1) % 3];
            if (a >= vertices)
                throw InputError(fmt::format("a triangle has the corner {}; there are {} vertices", a, vertices));
            auto& sides = edges.try_emplace(std::minmax(a, b), Sides{a, b, {}}).first->second;
            sides.opposite.push_back(t[(c + 2) % 3]);
        }
    return edges;
}

}  // namespace

void SurfaceEnergyOptions::check() const {
    for (const auto& [name, value] :
         {std::pair{"distance", distance}, std::pair{"strain", strain}, std::pair{"bending", bending}})
        if (!(value >= 0 && value <= 1e6))
            throw InputError(fmt::format("{} is {}; give a weight of 0 to 1000000", name, value));
    if (!(distance > 0)) throw InputError("distance is 0; without it nothing draws the surface to its target");
}

SurfaceEnergy::SurfaceEnergy(std::span<const Point> rest_mm, std::span<const geometry::Triangle> triangles,
                             const geometry::SurfaceIndex& target, const SurfaceEnergyOptions& options)
    : vertices_(rest_mm.size()), options_(options), target_(&target) {
    options.check();
    if (triangles.empty()) throw InputError("a surface without triangles has no shape to keep");
    const auto edges = edges_of(triangles, rest_mm.size());
    std::size_t inner = 0;
    for (const auto& [ends, sides] : edges) inner += sides.opposite.size() == 2 ? 1 : 0;
    for (std::uint32_t v = 0; v < vertices_; ++v)
        terms_.push_back({Kind::distance, 1, {v}, options.distance / static_cast<double>(vertices_), 0});
    const auto add = [&](Term term) {
        std::array<Point, most_corners> at;
        for (std::size_t c = 0; c < term.count; ++c) at[c] = rest_mm[term.corners[c]];
        term.at_rest = residual(term, at.data());
        if (term.weight > 0) terms_.push_back(term);
    };
    for (const auto& [ends, sides] : edges)
        add({Kind::strain, 2, {sides.from, sides.to}, options.strain / static_cast<double>(edges.size()), 0});
    for (const auto& [ends, sides] : edges)
        if (sides.opposite.size() == 2)
            add({Kind::bending,
                 4,
                 {sides.from, sides.to, sides.opposite[0], sides.opposite[1]},
                 options.bending / static_cast<double>(inner),
                 0});
}

double SurfaceEnergy::distance(const Point& at_mm, Vector* gradient) const {
    const auto hit = target_->closest(at_mm);
    const auto& corners = target_->triangles()[hit.triangle];
    const auto points = target_->vertices_mm();
    Vector normal = (points[corners[1]] - points[corners[0]]).cross(points[corners[2]] - points[corners[0]]);
    const double size = normal.norm();
    if (size > 0) normal /= size;
    const Vector away = at_mm - hit.position_mm;
    const double sign = away.dot(normal) < 0 ? -1 : 1;
    constexpr double on_it_mm = 1e-9;  // there its direction is that of rounding
    if (gradient) *gradient = hit.distance_mm > on_it_mm ? Vector(sign * away / hit.distance_mm) : normal;
    return sign * hit.distance_mm;
}

double SurfaceEnergy::residual(const Term& term, const Point* corners_mm, Vector* gradients) const {
    switch (term.kind) {
        case Kind::distance:
            return distance(corners_mm[0], gradients);
        case Kind::strain:
            return length(corners_mm, gradients) - term.at_rest;
        case Kind::bending:
            return normals_product(corners_mm, gradients) - term.at_rest;
    }
    return 0;
}

SurfaceEnergyParts SurfaceEnergy::of(std::span<const Point> pose_mm) const {
    if (pose_mm.size() != vertices_)
        throw InputError(fmt::format("a pose of {} points; the surface has {}", pose_mm.size(), vertices_));
    std::array<double, 3> sums = {0, 0, 0};
    for (const auto& term : terms_) {
        std::array<Point, most_corners> at;
        for (std::size_t c = 0; c < term.count; ++c) at[c] = pose_mm[term.corners[c]];
        sums[static_cast<std::size_t>(term.kind)] += term.weight * std::abs(residual(term, at.data()));
    }
    const auto without = [](double sum, double weight) { return weight > 0 ? sum / weight : 0.0; };
    return {without(sums[0], options_.distance), without(sums[1], options_.strain), without(sums[2], options_.bending),
            sums[0] + sums[1] + sums[2]};
}

}  // namespace mimik::capture
