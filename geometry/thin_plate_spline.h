#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/spline_kernel.h"
#include "geometry/types.h"

namespace mimik::geometry {

struct ThinPlateSplineOptions {
    SplineKernel kernel = SplineKernel::r;
    double smoothing = 0.0;  ///< X in K + X I, unit of K (mm, or mm^2 for r2_log_r2); 0 passes through every point
    /// Refuse controls that lie closer than this to one another, or to one common plane (thin clouds turn 1 mm of noise
    /// into centimetres off the plane). Shares of the size of their cloud (root mean square radius), so that they hold
    /// in any unit: on a face 0.5 nm and 0.5 micrometres.
    double min_separation_ratio = 1e-8;
    double min_thickness_ratio = 1e-5;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("kernel", self.kernel);
        visit("smoothing", self.smoothing);
        visit("min_separation_ratio", self.min_separation_ratio);
        visit("min_thickness_ratio", self.min_thickness_ratio);
    }
    void check() const;
};
static_assert(base::lists_every_field<ThinPlateSplineOptions>());

/// Thin-plate spline R^3 -> R^3 through point pairs (Eqs 4.11-4.19 with the misprints mended):
///     f(x) = a + A x + sum_i w_i U(|x - s_i|),   sum w_i = 0,   sum w_i s_i^T = 0,   (K + X I) W + P A = V
/// U carries its sign so that smoothing always smooths and bending_energy() is never negative. Default-made: identity.
class ThinPlateSpline {
public:
    ThinPlateSpline() = default;
    /// Needs n >= 4 pairs. O(n^3) once. Internally centred and scaled; the result is in the given coordinates.
    /// @param names  optional, as many as points: used in error messages.
    /// @throws InputError if counts differ or a value is not finite; NumericalError naming points that coincide or the
    /// plane they lie in.
    [[nodiscard]] static ThinPlateSpline fit(std::span<const Point> source_mm, std::span<const Point> target_mm,
                                             const ThinPlateSplineOptions& options = {},
                                             std::span<const std::string> names = {});

    [[nodiscard]] Point operator()(const Point& source_mm) const;
    /// Vectorised; the same values on any number of threads. `target_mm` has the size of `source_mm` (may be the same).
    void apply(std::span<const Point> source_mm, std::span<Point> target_mm) const;
    [[nodiscard]] std::vector<Point> apply(std::span<const Point> source_mm) const;
    /// Jacobian d f / d x at a point; at a control of kernel r, where it jumps, the mean of all directions.
    [[nodiscard]] Eigen::Matrix3d derivative(const Point& source_mm) const;
    [[nodiscard]] double bending_energy() const;  ///< trace(W^T K W) >= 0
    [[nodiscard]] std::size_t size() const { return centres_mm_.size(); }
    [[nodiscard]] SplineKernel kernel() const { return kernel_; }
    [[nodiscard]] std::span<const Vector> weights() const { return weights_; }  ///< w_i, in the given coordinates
    [[nodiscard]] const Transform& affine() const { return affine_; }

private:
    void evaluate(const Point* source_mm, Point* target_mm, std::size_t count) const;

    SplineKernel kernel_ = SplineKernel::r;
    std::vector<Point> centres_mm_;
    std::vector<Vector> weights_;
    Transform affine_ = Transform::Identity();
};

}  // namespace mimik::geometry
