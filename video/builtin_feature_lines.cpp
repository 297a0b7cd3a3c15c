#include "video/builtin_feature_lines.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "synthesis/builtin_curves.h"
#include "synthesis/builtin_sheet.h"

namespace mimik::video {
namespace {

using synthesis::Sheet;
namespace place = synthesis::place;

/// The vertices of one row of the sheet from s = `from` to `to`, by s.
std::vector<std::uint32_t> row_between(const Sheet& sheet, std::uint32_t row, double from, double to) {
    std::vector<std::uint32_t> line;
    for (std::uint32_t i = 0; i < sheet.vertices.size(); ++i) {
        const auto& vertex = sheet.vertices[i];
        if (vertex.row == row && vertex.s > from - 1e-9 && vertex.s < to + 1e-9) line.push_back(i);
    }
    std::sort(line.begin(), line.end(), [&](auto a, auto b) { return sheet.vertices[a].s < sheet.vertices[b].s; });
    return line;
}

/// The row at v; of two at the same v the lower one if `last`.
std::uint32_t row_at(const Sheet& sheet, double v, bool last = false) {
    std::uint32_t best = 0;
    for (std::uint32_t r = 0; r < sheet.row_v.size(); ++r) {
        const double now = std::abs(sheet.row_v[r] - v), then = std::abs(sheet.row_v[best] - v);
        if (now < then || (last && now == then)) best = r;
    }
    return best;
}

/// The vertices nearest to places (s, height(|s|)) between two distances from the midline, on one side.
std::vector<std::uint32_t> along(const Sheet& sheet, double from, double to, double side,
                                 const std::function<double(double)>& height) {
    std::vector<std::uint32_t> line;
    constexpr int steps = 16;
    for (int k = 0; k <= steps; ++k) {
        const double a = from + (to - from) * k / steps;
        const auto vertex = sheet.nearest(side * a, height(a));
        if (line.empty() || line.back() != vertex) line.push_back(vertex);
    }
    if (side * from > side * to) std::reverse(line.begin(), line.end());
    return line;
}

double brow_thickness(double a) { return 4.2 - 2.4 * synthesis::smooth_step(34, 52, a); }

/// The lower rim of the nostril and the sill beside it.
double under_nostril(double a) {
    const double q = (a - 7.0) / 6.5;
    return -52.2 - 1.9 * std::sqrt(std::max(0.0, 1 - q * q));
}

void add_curves(const Sheet& sheet, BuiltinFeatureLines& lines) {
    const auto set = [&](FaceCurve curve, std::vector<std::uint32_t> line) {
        lines.curves[static_cast<std::size_t>(curve)] = std::move(line);
    };
    const auto brow_top = [](double a) { return synthesis::brow_line(a) + brow_thickness(a); };
    const auto brow_bottom = [](double a) { return synthesis::brow_line(a) - brow_thickness(a); };
    set(FaceCurve::brow_right_upper, along(sheet, 53, 9, -1, brow_top));
    set(FaceCurve::brow_right_lower, along(sheet, 53, 9, -1, brow_bottom));
    set(FaceCurve::brow_left_upper, along(sheet, 9, 53, 1, brow_top));
    set(FaceCurve::brow_left_lower, along(sheet, 9, 53, 1, brow_bottom));
    const auto upper = row_at(sheet, place::upper_lid), lower = row_at(sheet, place::lower_lid);
    set(FaceCurve::lid_right_upper, row_between(sheet, upper, -place::outer_canthus, -place::inner_canthus));
    set(FaceCurve::lid_right_lower, row_between(sheet, lower, -place::outer_canthus, -place::inner_canthus));
    set(FaceCurve::lid_left_upper, row_between(sheet, upper, place::inner_canthus, place::outer_canthus));
    set(FaceCurve::lid_left_lower, row_between(sheet, lower, place::inner_canthus, place::outer_canthus));
    set(FaceCurve::nostril_right, along(sheet, 13, 1.5, -1, under_nostril));
    set(FaceCurve::nostril_left, along(sheet, 1.5, 13, 1, under_nostril));
    const double corner = place::mouth_corner;
    set(FaceCurve::lip_outer_upper, row_between(sheet, row_at(sheet, place::upper_lip), -corner, corner));
    set(FaceCurve::lip_outer_lower, row_between(sheet, row_at(sheet, place::lower_lip), -corner, corner));
    const auto inner = row_between(sheet, row_at(sheet, place::stomion), -corner, corner);
    auto lower_inner = row_between(sheet, row_at(sheet, place::stomion, true), -corner, corner);
    lower_inner.insert(lower_inner.begin(), inner.front());
    lower_inner.push_back(inner.back());
    set(FaceCurve::lip_inner_upper, inner);
    set(FaceCurve::lip_inner_lower, std::move(lower_inner));
}

void add_jaw_and_nose(const Sheet& sheet, BuiltinFeatureLines& lines) {
    constexpr std::array<std::array<double, 2>, 9> jaw = {
        {{100, -8}, {98, -32}, {95, -58}, {91, -84}, {80, -104}, {62, -116}, {42, -120}, {21, -121}, {0, -121}}};
    for (std::size_t k = 0; k < jaw.size(); ++k) {
        lines.points[k] = sheet.nearest(-jaw[k][0], jaw[k][1]);
        lines.points[16 - k] = sheet.nearest(jaw[k][0], jaw[k][1]);
    }
    constexpr std::array<double, 4> bridge = {-3, -16, -29, place::pronasale};
    for (std::size_t k = 0; k < bridge.size(); ++k) lines.points[27 + k] = sheet.nearest(0, bridge[k]);
}

}  // namespace

BuiltinFeatureLines builtin_feature_lines() {
    const auto sheet = synthesis::make_sheet();
    BuiltinFeatureLines lines;
    add_curves(sheet, lines);
    add_jaw_and_nose(sheet, lines);
    // The points on curves: the vertex of the line at the share of it that face_curves.h gives the point.
    for (const auto& place68 : places_on_curves()) {
        const auto& line = lines.curves[static_cast<std::size_t>(place68.first)];
        const auto at = static_cast<std::size_t>(std::lround(place68.t * static_cast<double>(line.size() - 1)));
        lines.points[static_cast<std::size_t>(place68.point)] = line[at];
    }
    return lines;
}

}  // namespace mimik::video
