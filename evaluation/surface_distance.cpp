#include "evaluation/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/box.h"
#include "geometry/polygon_triangles.h"
#include "geometry/statistics.h"

namespace mimik::evaluation {
namespace {

using geometry::Mesh;
using geometry::Point;
using geometry::SurfaceIndex;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void check_mask(std::size_t mask, std::size_t vertices) {
    if (mask != 0 && mask != vertices)
        throw InputError(fmt::format("the mask has {} for {} vertices; give one per vertex or none",
                                     base::counted(mask, "entry", "entries"), vertices));
}

}  // namespace

DistanceSummary summarize(std::span<const double> distance_mm, std::span<const std::uint8_t> on_border,
                          std::span<const std::uint8_t> counts) {
    check_mask(counts.size(), distance_mm.size());
    check_mask(on_border.size(), distance_mm.size());
    DistanceSummary summary;
    std::vector<double> kept;
    kept.reserve(distance_mm.size());
    double sum = 0.0, squares = 0.0;
    for (std::size_t v = 0; v < distance_mm.size(); ++v) {
        if (!counts.empty() && counts[v] == 0) continue;
        const double d = distance_mm[v];
        if (!std::isfinite(d)) throw InputError(fmt::format("the distance of vertex {} is {}; mask it out", v, d));
        kept.push_back(d);
        sum += d;
        squares += d * d;
        if (!on_border.empty() && on_border[v] != 0) ++summary.border_hits;
    }
    if (kept.empty())
        throw InputError(fmt::format("none of {} vertices counts; there is nothing to measure", distance_mm.size()));
    summary.n = kept.size();
    const auto n = static_cast<double>(kept.size());
    summary.mean_mm = sum / n;
    summary.rms_mm = std::sqrt(squares / n);
    summary.median_mm = geometry::quantile(kept, 0.5);
    summary.p95_mm = geometry::quantile(kept, 0.95);
    summary.max_mm = *std::max_element(kept.begin(), kept.end());
    return summary;
}

VertexDistances distances_to_surface(std::span<const Point> vertices_mm, const SurfaceIndex& reference,
                                     std::span<const std::uint8_t> counts) {
    check_mask(counts.size(), vertices_mm.size());
    VertexDistances result;
    result.distance_mm.assign(vertices_mm.size(), nan);
    result.on_border.assign(vertices_mm.size(), 0);
    std::vector<std::uint32_t> asked;
    std::vector<Point> queries;
    asked.reserve(vertices_mm.size());
    queries.reserve(vertices_mm.size());
    for (std::uint32_t v = 0; v < vertices_mm.size(); ++v) {
        if (!counts.empty() && counts[v] == 0) continue;
        if (!vertices_mm[v].allFinite())
            throw InputError(fmt::format("vertex {} is ({}, {}, {}); mask out vertices without a measurement", v,
                                         vertices_mm[v].x(), vertices_mm[v].y(), vertices_mm[v].z()));
        asked.push_back(v);
        queries.push_back(vertices_mm[v]);
    }
    const auto answers = reference.closest(queries);
    for (std::size_t i = 0; i < asked.size(); ++i) {
        result.distance_mm[asked[i]] = answers[i].distance_mm;
        result.on_border[asked[i]] = reference.on_border(answers[i]) ? 1 : 0;
    }
    result.summary = summarize(result.distance_mm, result.on_border, counts);
    return result;
}

namespace {

/// Products of coordinates that are large beside the surface lose the digits of its details: such a surface, in the
/// frame of a country, say, is measured near the origin. Its middle in whole numbers, so that moving it there loses
/// nothing; zero for every other.
Point far_origin(const Mesh& reference) {
    const auto box = geometry::box_of(reference.vertices_mm);
    constexpr double far = 100;  // surface sizes
    if (box.isEmpty() || box.center().norm() <= far * box.diagonal().norm()) return Point::Zero();
    return box.center().array().round();
}

std::vector<Point> moved_by(const std::vector<Point>& points, const Point& shift) {
    std::vector<Point> moved;
    moved.reserve(points.size());
    for (const auto& p : points) moved.emplace_back(p + shift);
    return moved;
}

}  // namespace

SurfaceDistance surface_distance(const Mesh& test, const Mesh& reference) {
    if (reference.faces.size() == 0)
        throw InputError(fmt::format("the reference has {} but no face; distances need a surface: give a mesh",
                                     base::counted(reference.vertices_mm.size(), "vertex", "vertices")));
    if (const Point origin = far_origin(reference); !origin.isZero(0.0)) {
        Mesh near_test, near_reference;
        near_test.faces = test.faces;
        near_reference.faces = reference.faces;
        near_test.vertices_mm = moved_by(test.vertices_mm, -origin);
        near_reference.vertices_mm = moved_by(reference.vertices_mm, -origin);
        // A surface that is a speck beside its distance even now has no digits left to save.
        if (far_origin(near_reference).isZero(0.0)) return surface_distance(near_test, near_reference);
    }
    SurfaceDistance result;
    result.test_to_reference = distances_to_surface(
        test.vertices_mm,
        SurfaceIndex(reference.vertices_mm, geometry::triangulate(reference.faces, reference.vertices_mm)));
    if (test.faces.size() > 0)
        result.reference_to_test = distances_to_surface(
            reference.vertices_mm, SurfaceIndex(test.vertices_mm, geometry::triangulate(test.faces, test.vertices_mm)));
    return result;
}

}  // namespace mimik::evaluation
