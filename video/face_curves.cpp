#include "video/face_curves.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "base/errors.h"

namespace mimik::video {
namespace {

using enum FaceCurve;

// The points of a brow are on its upper edge, where annotators of the 68 points put them.
constexpr std::array<PlaceOnCurves, 47> places = {
    {{17, brow_right_upper, brow_right_upper, 0},   {18, brow_right_upper, brow_right_upper, 0.25},
     {19, brow_right_upper, brow_right_upper, 0.5}, {20, brow_right_upper, brow_right_upper, 0.75},
     {21, brow_right_upper, brow_right_upper, 1},   {22, brow_left_upper, brow_left_upper, 0},
     {23, brow_left_upper, brow_left_upper, 0.25},  {24, brow_left_upper, brow_left_upper, 0.5},
     {25, brow_left_upper, brow_left_upper, 0.75},  {26, brow_left_upper, brow_left_upper, 1},
     {31, nostril_right, nostril_right, 0.1},       {32, nostril_right, nostril_right, 0.55},
     {33, nostril_right, nostril_right, 1},         {34, nostril_left, nostril_left, 0.45},
     {35, nostril_left, nostril_left, 0.9},         {36, lid_right_upper, lid_right_lower, 0},
     {37, lid_right_upper, lid_right_upper, 0.33},  {38, lid_right_upper, lid_right_upper, 0.67},
     {39, lid_right_upper, lid_right_lower, 1},     {40, lid_right_lower, lid_right_lower, 0.67},
     {41, lid_right_lower, lid_right_lower, 0.33},  {42, lid_left_upper, lid_left_lower, 0},
     {43, lid_left_upper, lid_left_upper, 0.33},    {44, lid_left_upper, lid_left_upper, 0.67},
     {45, lid_left_upper, lid_left_lower, 1},       {46, lid_left_lower, lid_left_lower, 0.67},
     {47, lid_left_lower, lid_left_lower, 0.33},    {48, lip_outer_upper, lip_outer_lower, 0},
     {49, lip_outer_upper, lip_outer_upper, 0.2},   {50, lip_outer_upper, lip_outer_upper, 0.38},
     {51, lip_outer_upper, lip_outer_upper, 0.5},   {52, lip_outer_upper, lip_outer_upper, 0.62},
     {53, lip_outer_upper, lip_outer_upper, 0.8},   {54, lip_outer_upper, lip_outer_lower, 1},
     {55, lip_outer_lower, lip_outer_lower, 0.8},   {56, lip_outer_lower, lip_outer_lower, 0.65},
     {57, lip_outer_lower, lip_outer_lower, 0.5},   {58, lip_outer_lower, lip_outer_lower, 0.35},
     {59, lip_outer_lower, lip_outer_lower, 0.2},   {60, lip_inner_upper, lip_inner_lower, 0.05},
     {61, lip_inner_upper, lip_inner_upper, 0.32},  {62, lip_inner_upper, lip_inner_upper, 0.5},
     {63, lip_inner_upper, lip_inner_upper, 0.68},  {64, lip_inner_upper, lip_inner_lower, 0.95},
     {65, lip_inner_lower, lip_inner_lower, 0.68},  {66, lip_inner_lower, lip_inner_lower, 0.5},
     {67, lip_inner_lower, lip_inner_lower, 0.32}}};

}  // namespace

std::array<double, 4> bernstein(double t) {
    const double u = 1 - t;
    return {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
}

Pixel BezierCurve::at(double t) const {
    const auto b = bernstein(t);
    return b[0] * control[0] + b[1] * control[1] + b[2] * control[2] + b[3] * control[3];
}

Pixel BezierCurve::tangent(double t) const {
    const double u = 1 - t;
    return 3 * u * u * (control[1] - control[0]) + 6 * u * t * (control[2] - control[1]) +
           3 * t * t * (control[3] - control[2]);
}

BezierCurve fit_curve(std::span<const Pixel> points) {
    if (points.size() < 2) throw InputError("a curve needs two points or more");
    BezierCurve curve;
    const Pixel first = points.front(), last = points.back();
    curve.control = {first, first + (last - first) / 3, first + 2 * (last - first) / 3, last};
    double length = 0;
    for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
    if (points.size() < 4 || !(length > 0)) return curve;
    // The normal equations of the two inner control points.
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d sums = Eigen::Matrix2d::Zero();
    double gone = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (k > 0) gone += (points[k] - points[k - 1]).norm();
        const auto b = bernstein(gone / length);
        const Pixel rest = points[k] - b[0] * first - b[3] * last;
        const Eigen::Vector2d inner(b[1], b[2]);
        squares += inner * inner.transpose();
        sums += inner * rest.transpose();
    }
    const Eigen::Matrix2d solved = squares.ldlt().solve(sums);
    if (!solved.allFinite()) return curve;
    curve.control[1] = solved.row(0);
    curve.control[2] = solved.row(1);
    return curve;
}

double distance_px(const BezierCurve& curve, const Pixel& point) {
    constexpr int pieces = 32;
    double best = (curve.at(0) - point).norm();
    Pixel from = curve.at(0);
    for (int k = 1; k <= pieces; ++k) {
        const Pixel to = curve.at(static_cast<double>(k) / pieces), along = to - from;
        const double squared = along.squaredNorm();
        const double share = squared > 0 ? std::clamp((point - from).dot(along) / squared, 0.0, 1.0) : 0.0;
        best = std::min(best, (from + share * along - point).norm());
        from = to;
    }
    return best;
}

std::string_view name_of(FaceCurve curve) {
    constexpr std::array<std::string_view, curve_count> names = {
        "brow_right_upper", "brow_right_lower", "brow_left_upper", "brow_left_lower", "lid_right_upper",
        "lid_right_lower",  "lid_left_upper",   "lid_left_lower",  "nostril_right",   "nostril_left",
        "lip_outer_upper",  "lip_outer_lower",  "lip_inner_upper", "lip_inner_lower"};
    return names.at(static_cast<std::size_t>(curve));
}

std::span<const PlaceOnCurves> places_on_curves() { return places; }

void points_on_curves(const FaceCurves& curves, Points68& points) {
    for (const auto& place : places)
        points[static_cast<std::size_t>(place.point)] =
            place.first == place.second ? curves[place.first].at(place.t)
                                        : 0.5 * (curves[place.first].at(place.t) + curves[place.second].at(place.t));
}

FaceCurves curves_through(const Points68& points) {
    const auto through = [&](std::initializer_list<std::size_t> numbers, const Pixel& shift = Pixel::Zero()) {
        std::vector<Pixel> row;
        for (const auto number : numbers) row.push_back(points[number] + shift);
        return fit_curve(row);
    };
    FaceCurves curves;
    // The points of a brow lie along its upper edge; the lower one is a share of the eyes' distance away.
    const Pixel down = 0.07 * Pixel(-(points[45] - points[36]).y(), (points[45] - points[36]).x());
    curves[brow_right_upper] = through({17, 18, 19, 20, 21});
    curves[brow_right_lower] = through({17, 18, 19, 20, 21}, down);
    curves[brow_left_upper] = through({22, 23, 24, 25, 26});
    curves[brow_left_lower] = through({22, 23, 24, 25, 26}, down);
    curves[lid_right_upper] = through({36, 37, 38, 39});
    curves[lid_right_lower] = through({36, 41, 40, 39});
    curves[lid_left_upper] = through({42, 43, 44, 45});
    curves[lid_left_lower] = through({42, 47, 46, 45});
    curves[nostril_right] = through({31, 32, 33});
    curves[nostril_left] = through({33, 34, 35});
    curves[lip_outer_upper] = through({48, 49, 50, 51, 52, 53, 54});
    curves[lip_outer_lower] = through({48, 59, 58, 57, 56, 55, 54});
    curves[lip_inner_upper] = through({60, 61, 62, 63, 64});
    curves[lip_inner_lower] = through({60, 67, 66, 65, 64});
    return curves;
}

}  // namespace mimik::video
