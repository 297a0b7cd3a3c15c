#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "geometry/thin_plate_spline.h"
#include "report/drawn_face.h"
#include "report/named_figure.h"

// Chapter 4 of the thesis: the basis function and a warp by five points.

namespace mimik::report::thesis_figures {
namespace {

using geometry::Point;

/// A square of n x n quads, each vertex where `at` puts the parameters -1 to 1. Seen from the side that +y points to.
geometry::Mesh square_patch(int n, const std::function<Point(double, double)>& at) {
    geometry::Mesh mesh;
    for (int row = 0; row <= n; ++row)
        for (int col = 0; col <= n; ++col) mesh.vertices_mm.push_back(at(2.0 * col / n - 1, 2.0 * row / n - 1));
    const auto index = [&](int row, int col) { return static_cast<std::uint32_t>(row * (n + 1) + col); };
    for (int row = 0; row < n; ++row)
        for (int col = 0; col < n; ++col)
            mesh.faces.add(
                std::array{index(row, col), index(row + 1, col), index(row + 1, col + 1), index(row, col + 1)});
    return mesh;
}

/// U(r) = r^2 ln r^2, Eq. 4.4.
double basis(double r) { return r > 0 ? r * r * std::log(r * r) : 0.0; }

FigurePlan basis_function(const FigureCast&) {
    constexpr double reach = 1.25, unit_mm = 60;  // a little beyond the zeros at r = 1
    const auto height = [](double x, double y) { return -basis(std::hypot(x, y)); };
    figures::Panel panel;
    panel.mesh = square_patch(48, [&](double u, double v) {
        return Point(unit_mm * reach * u, unit_mm * height(reach * u, reach * v), unit_mm * reach * v);
    });
    geometry::VertexAttribute values{"height", 1, {}};
    for (const auto& p : panel.mesh.vertices_mm) values.values.push_back(p.y() / unit_mm);
    panel.mesh.attributes.push_back(std::move(values));
    panel.scalar = figures::Scalar{.attribute = "height",
                                   .label = "z = -U(r)",
                                   .range = std::array{-0.8, 0.8},
                                   .map = figures::ColourMap::diverging};
    panel.wire_frame = true;
    panel.view = {.yaw_deg = 28, .pitch_deg = 32};
    figures::MarkerSet zeros{.name = "zeros: r = 0 and r = 1", .colour = {30, 30, 30}, .radius_mm = 0.9};
    zeros.positions_mm.emplace_back(0, 0, 0);
    constexpr int around = 72;
    for (int k = 0; k < around; ++k) {
        const double angle = 2 * std::numbers::pi * k / around;
        zeros.positions_mm.emplace_back(unit_mm * std::cos(angle), 0, unit_mm * std::sin(angle));
    }
    figures::MarkerSet top{.name = "greatest: r = 1/sqrt(e)", .colour = figures::muscle_colour, .radius_mm = 0.9};
    const double ring = 1 / std::sqrt(std::numbers::e);
    for (int k = 0; k < around; ++k) {
        const double angle = 2 * std::numbers::pi * k / around;
        top.positions_mm.emplace_back(unit_mm * ring * std::cos(angle), unit_mm * height(ring, 0),
                                      unit_mm * ring * std::sin(angle));
    }
    panel.markers = {zeros, top};
    FigurePlan plan;
    plan.picture = page_of(1, "z(x, y) = -U(r), U(r) = r² ln r²");
    plan.picture.panel_width_px = 1300;
    plan.picture.panel_height_px = 900;
    plan.picture.scale_bar_mm = 0;
    plan.picture.panels.push_back(std::move(panel));
    plan.caption =
        "The surface z(x, y) = -U(r) of the basis function of thin-plate splines, Eq. 4.4. It is 0 in the middle and "
        "on the circle r = 1, and greatest on the circle r = 1/sqrt(e).";
    return plan;
}

FigurePlan five_point_surface(const FigureCast&) {
    constexpr double half_mm = 60;
    // Slightly domed: five points of one plane have no spline in three dimensions (the matrix P loses a rank).
    const auto patch = [](double u, double v) {
        return Point(half_mm * u, 6 * (1 - (u * u + v * v) / 2), half_mm * v);
    };
    const std::vector<Point> source = {patch(-1, -1), patch(1, -1), patch(1, 1), patch(-1, 1), patch(0, 0)};
    const std::vector<Point> target = {source[0] + Point(-8, 14, -4), source[1] + Point(10, -6, -6),
                                       source[2] + Point(6, 16, 8), source[3] + Point(-6, -10, 10),
                                       source[4] + Point(6, 42, -4)};
    const auto spline =
        geometry::ThinPlateSpline::fit(source, target, {.kernel = geometry::SplineKernel::r2_log_r2, .smoothing = 0});
    const auto panel_of = [&](bool warped) {
        figures::Panel panel;
        panel.lit_as_skin = true;
        panel.mesh = square_patch(24, patch);
        if (warped) panel.mesh.vertices_mm = spline.apply(panel.mesh.vertices_mm);
        panel.wire_frame = true;
        panel.view = {.yaw_deg = 24, .pitch_deg = 34};
        panel.centre_mm = Point(0, 14, 0);
        panel.markers.push_back({.name = "control points",
                                 .colour = figures::landmark_colour,
                                 .radius_mm = 2.6,
                                 .positions_mm = warped ? target : source});
        panel.caption = warped ? "the patch, warped by them" : "a patch and its five control points";
        if (!warped) {
            figures::ArrowSet ways{.name = "displacements"};
            for (std::size_t k = 0; k < source.size(); ++k) ways.arrows.push_back({source[k], target[k]});
            panel.arrows.push_back(ways);
        }
        return panel;
    };
    FigurePlan plan;
    plan.picture = page_of(2, "A thin-plate spline through five points");
    plan.picture.panel_width_px = 860;
    plan.picture.panel_height_px = 640;
    plan.picture.scale_bar_mm = 0;
    plan.picture.panels = {panel_of(false), panel_of(true)};
    letter_panels(plan.picture);
    plan.caption =
        "A surface patch controlled by five points. They are moved in three dimensions, and all other points of the "
        "surface follow by the spline of Eq. 4.19 with U(r) = r² ln r².";
    plan.remarks.push_back("the patch is slightly domed: five points of one plane have no spline in three dimensions");
    return plan;
}

}  // namespace

std::vector<NamedFigure> splines_figures() {
    return {{"4-5", "Graph of the basis function U(r)", "nothing", FigureNeeds::nothing, basis_function},
            {"4-6", "A thin-plate spline surface with five control points in 3D", "nothing", FigureNeeds::nothing,
             five_point_surface}};
}

}  // namespace mimik::report::thesis_figures
