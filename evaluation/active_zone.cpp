#include "evaluation/active_zone.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/errors.h"
#include "facs/expression_zone.h"
#include "geometry/landmark_spline.h"
#include "preprocessing/nearest_on_average.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::Vector;
using preprocessing::AverageFace;
using preprocessing::Face;

namespace {

constexpr double rim_mm = 5.0;  // five cells beyond the average face's border: no zone is known there

}  // namespace

std::vector<Point> average_vertices_on(const AverageFace& average, const Face& face) {
    std::vector<Point> vertices;
    for (std::size_t v = 0; v < average.grid.size(); ++v)
        vertices.push_back(average.grid.inside(v) ? average.grid.vertices_mm[v] : Point(Point::Zero()));
    geometry::landmark_spline(average.landmarks, face.landmarks).apply(vertices, vertices);
    return vertices;
}

std::vector<Vector> true_motion_on_average(const AverageFace& average, const Face& neutral,
                                           const database::TrueScan& true_neutral,
                                           std::span<const Vector> true_field_mm) {
    const auto points = database::material_points(true_neutral, average_vertices_on(average, neutral));
    const Eigen::Matrix3d average_from_head =
        neutral.average_from_scan.linear() * true_neutral.scanner_from_head.linear();
    std::vector<Vector> motion(average.grid.size(), Vector::Zero());
    for (std::size_t v = 0; v < motion.size(); ++v)
        if (average.grid.inside(v)) motion[v] = average_from_head * points.at(true_field_mm, v);
    return motion;
}

MotionZone::MotionZone(const AverageFace& average) : average_(average), sum_(average.grid.size(), Vector::Zero()) {}

void MotionZone::add(std::span<const Vector> motion_mm) {
    for (std::size_t v = 0; v < sum_.size(); ++v) sum_[v] += motion_mm[v];
    ++subjects_;
}

double MotionZone::largest_mm() const {
    double largest = 0;
    for (const auto& total : sum_) largest = std::max(largest, total.norm());
    return subjects_ > 0 ? largest / static_cast<double>(subjects_) : 0;
}

ActiveZone MotionZone::zone(const facs::Expression& expression, double share) const {
    if (subjects_ == 0) throw InputError(fmt::format("{}: no subject says where it moves the skin", expression.code()));
    ActiveZone zone;
    zone.expression = expression;
    for (const auto& total : sum_) zone.displacement_mm.push_back(total.norm() / static_cast<double>(subjects_));
    const double largest = largest_mm();
    for (std::size_t v = 0; v < sum_.size(); ++v)
        zone.active.push_back(average_.grid.inside(v) && zone.displacement_mm[v] > share * largest ? 1 : 0);
    return zone;
}

ActiveZone shipped_active_zone(const facs::Expression& expression, const AverageFace& average) {
    const auto& shipped = facs::builtin_catalogue();
    const auto units = expression.units();
    const bool known = std::all_of(units.begin(), units.end(),
                                   [&](const facs::UnitOnSide& part) { return shipped.find(part.unit) != nullptr; }) &&
                       (!units.empty() || shipped.find_expression(expression.code()));
    std::optional<facs::ExpressionZone> drawn;
    if (known) drawn.emplace(shipped, expression, average.landmarks);
    ActiveZone zone;
    zone.expression = expression;
    for (std::size_t v = 0; v < average.grid.size(); ++v)
        zone.active.push_back(
            average.grid.inside(v) && (!drawn || drawn->distance(average.grid.vertices_mm[v]) <= 0) ? 1 : 0);
    return zone;
}

void unite(ActiveZone& zone, const ActiveZone& other) {
    for (std::size_t v = 0; v < zone.active.size(); ++v)
        if (other.active[v]) zone.active[v] = 1;
}

geometry::VertexMask carry_zone(const ActiveZone& zone, const AverageFace& average, const Face& face) {
    const auto nearest = preprocessing::nearest_on_average(face, average);
    geometry::VertexMask active(face.grid.size(), 0);
    for (std::size_t v = 0; v < active.size(); ++v)
        if (nearest[v].distance_mm < rim_mm) active[v] = zone.active[nearest[v].vertex];
    return active;
}

}  // namespace mimik::evaluation
