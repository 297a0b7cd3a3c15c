#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "geometry/types.h"

namespace mimik::video {

/// A place in an image: x to the right, y down, in pixels; the middle of the first pixel is (0, 0), as OpenCV has it.
using Pixel = Eigen::Vector2d;

/// A cubic Bezier curve with four control points.
struct BezierCurve {
    std::array<Pixel, 4> control{Pixel::Zero(), Pixel::Zero(), Pixel::Zero(), Pixel::Zero()};

    /// @param t  0 at the first control point, 1 at the last
    [[nodiscard]] Pixel at(double t) const;
    [[nodiscard]] Pixel tangent(double t) const;  ///< the derivative by t
};
/// The four Bernstein polynomials of degree three at t.
[[nodiscard]] std::array<double, 4> bernstein(double t);

/// The curve nearest to a row of points, by least squares: its ends are the row's ends, a point's parameter is its
/// share of the row's length. @throws InputError if there are fewer than two points.
[[nodiscard]] BezierCurve fit_curve(std::span<const Pixel> points);

/// Distance of a point from a curve, in pixels.
[[nodiscard]] double distance_px(const BezierCurve& curve, const Pixel& point);

/// Outlines of features (Sec. 3.3). Each runs from the subject's right to the left: in the image from left to right.
enum class FaceCurve : std::size_t {
    brow_right_upper,
    brow_right_lower,
    brow_left_upper,
    brow_left_lower,
    lid_right_upper,
    lid_right_lower,
    lid_left_upper,
    lid_left_lower,
    nostril_right,  ///< the lower rim, from the wing to the midline
    nostril_left,
    lip_outer_upper,
    lip_outer_lower,
    lip_inner_upper,
    lip_inner_lower,
    count
};
inline constexpr std::size_t curve_count = static_cast<std::size_t>(FaceCurve::count);
[[nodiscard]] std::string_view name_of(FaceCurve curve);

/// All curves of one face.
struct FaceCurves {
    std::array<BezierCurve, curve_count> curve;
    [[nodiscard]] BezierCurve& operator[](FaceCurve c) { return curve[static_cast<std::size_t>(c)]; }
    [[nodiscard]] const BezierCurve& operator[](FaceCurve c) const { return curve[static_cast<std::size_t>(c)]; }
};

/// The curves of the built-in mean face at rest, seen from the front. The middle between the outer eye corners is the
/// origin, their distance is 1, x is to the right of the image, y down.
[[nodiscard]] const FaceCurves& mean_face_curves();

/// The 68 usual points on the same mean face, mm: origin in the middle between the outer eye corners, +x the subject's
/// left, +y up, +z out of the face.
[[nodiscard]] const std::array<geometry::Point, 68>& mean_face_points68_mm();
/// Distance of its outer eye corners.
[[nodiscard]] double mean_face_outer_eyes_mm();

/// Where on the curves one of the 68 points lies: at parameter `t` of one, or in the middle between two.
struct PlaceOnCurves {
    int point = 0;                                                  ///< 0 to 67
    FaceCurve first = FaceCurve::count, second = FaceCurve::count;  ///< second = first: one curve alone
    double t = 0;
};
[[nodiscard]] std::span<const PlaceOnCurves> places_on_curves();

using Points68 = std::array<Pixel, 68>;
/// Those of the 68 points that lie on the curves: brows, lids, lips, and the row under the nose. The others (the jaw,
/// 0 to 16, and the bridge and tip of the nose, 27 to 30) are left as they are.
void points_on_curves(const FaceCurves& curves, Points68& points);
/// The other way round: curves through the points of another tracker.
[[nodiscard]] FaceCurves curves_through(const Points68& points);

}  // namespace mimik::video
