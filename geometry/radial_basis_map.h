#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/thin_plate_spline.h"
#include "geometry/types.h"

namespace mimik::geometry {

/// phi(d) of a centre with the radius r.
enum class RadialKernel {
    inverse_multiquadric,  ///< 1 / sqrt(d^2 + r^2), Eq. 15 of Sanchez et al. 2003
    gaussian,              ///< exp(-d^2 / r^2)
    wendland,              ///< (1 - d/r)^4 (4 d/r + 1) within r, else 0 (Wendland 1995, C2 in three dimensions)
    r,                     ///< SplineKernel::r, without a radius
    r2_log_r2              ///< SplineKernel::r2_log_r2, without a radius: the thin-plate spline of the thesis
};
[[nodiscard]] const char* to_string(RadialKernel kernel);  ///< "imq", "gaussian", "wendland", "r", "r2logr"

struct RadialBasisOptions {
    RadialKernel kernel = RadialKernel::inverse_multiquadric;
    /// The radius of a centre is this times the distance to its nearest neighbour (Eq. 16). None: 1 as published; 2 for
    /// the Gaussian and 6 for Wendland's function, which else would hardly reach the next centre.
    std::optional<double> radius_ratio = {};
    /// As ThinPlateSplineOptions: centres that lie closer, or flatter, are refused.
    double min_separation_ratio = 1e-8;
    double min_thickness_ratio = 1e-5;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("kernel", self.kernel);
        visit("radius_ratio", self.radius_ratio);
        visit("min_separation_ratio", self.min_separation_ratio);
        visit("min_thickness_ratio", self.min_thickness_ratio);
    }
    /// @throws InputError if a number is not what it must be.
    void check() const;
    [[nodiscard]] double ratio() const;  ///< radius_ratio, or the kernel's own
};
static_assert(base::lists_every_field<RadialBasisOptions>());

/// A map R^3 -> R^3 through point pairs, of radial functions each with a radius of its own and an affine part (Arad et
/// al. 1994; Eqs 13-16 of Sanchez et al. 2003):
///     f(x) = a + A x + sum_i w_i phi_i(|x - s_i|),   sum w_i = 0,   sum w_i s_i^T = 0
/// With radii of their own the matrix is not symmetric, so it is solved by LU decomposition; kernels without a radius
/// are ThinPlateSpline's. An affine motion of the centres is met exactly by every kernel.
class RadialBasisMap {
public:
    /// Needs n >= 4 pairs. O(n^3) once. @param names  optional, as many as points: used in error messages.
    /// @throws InputError if counts differ or a value is not finite; NumericalError naming points that coincide or the
    /// plane they lie in, or where the system is singular in double precision.
    [[nodiscard]] static RadialBasisMap fit(std::span<const Point> source_mm, std::span<const Point> target_mm,
                                            const RadialBasisOptions& options = {},
                                            std::span<const std::string> names = {});

    [[nodiscard]] Point operator()(const Point& source_mm) const;
    /// The same values on any number of threads. `target_mm` has the size of `source_mm` (may be the same).
    void apply(std::span<const Point> source_mm, std::span<Point> target_mm) const;
    [[nodiscard]] std::span<const double> radii_mm() const { return radii_mm_; }  ///< empty: a kernel without radius
    [[nodiscard]] std::span<const Vector> weights() const { return weights_; }
    [[nodiscard]] const Transform& affine() const { return affine_; }

private:
    RadialKernel kernel_ = RadialKernel::inverse_multiquadric;
    std::optional<ThinPlateSpline> spline_;  ///< of a kernel without radius, which is all of it then
    std::vector<Point> centres_mm_;
    std::vector<double> radii_mm_;
    std::vector<Vector> weights_;
    Transform affine_ = Transform::Identity();
};

}  // namespace mimik::geometry
