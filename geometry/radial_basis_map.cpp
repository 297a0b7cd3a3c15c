#include "geometry/radial_basis_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"

namespace mimik::geometry {

const char* to_string(RadialKernel kernel) {
    switch (kernel) {
        case RadialKernel::inverse_multiquadric:
            return "imq";
        case RadialKernel::gaussian:
            return "gaussian";
        case RadialKernel::wendland:
            return "wendland";
        case RadialKernel::r:
            return "r";
        case RadialKernel::r2_log_r2:
            return "r2logr";
    }
    return "imq";
}

namespace {

constexpr std::size_t points_per_piece = 1024;

bool has_radius(RadialKernel kernel) { return kernel != RadialKernel::r && kernel != RadialKernel::r2_log_r2; }

double value_of(RadialKernel kernel, double squared_distance, double radius) {
    const double squared = squared_distance / (radius * radius);
    if (kernel == RadialKernel::gaussian) return std::exp(-squared);
    if (kernel == RadialKernel::inverse_multiquadric) return 1 / std::sqrt(squared_distance + radius * radius);
    const double share = std::sqrt(squared), rest = 1 - share;
    return share < 1 ? rest * rest * rest * rest * (4 * share + 1) : 0;
}

ThinPlateSplineOptions spline_options(const RadialBasisOptions& options) {
    ThinPlateSplineOptions spline;
    spline.kernel = options.kernel == RadialKernel::r2_log_r2 ? SplineKernel::r2_log_r2 : SplineKernel::r;
    spline.min_separation_ratio = options.min_separation_ratio;
    spline.min_thickness_ratio = options.min_thickness_ratio;
    return spline;
}

/// Eq. 16, times the ratio.
std::vector<double> radii(const Eigen::Matrix3Xd& points, double ratio) {
    std::vector<double> list;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (Eigen::Index j = 0; j < points.cols(); ++j)
            if (j != i) least = std::min(least, (points.col(i) - points.col(j)).norm());
        list.push_back(ratio * least);
    }
    return list;
}

}  // namespace

void RadialBasisOptions::check() const {
    spline_options(*this).check();
    if (!radius_ratio) return;
    if (!std::isfinite(*radius_ratio) || *radius_ratio <= 0)
        throw InputError(fmt::format("radius_ratio is {}; give more than 0", *radius_ratio));
    if (!has_radius(kernel))
        throw InputError(
            fmt::format("radius_ratio is {}, and kernel {} has no radius; leave it off, or take imq, "
                        "gaussian or wendland",
                        *radius_ratio, to_string(kernel)));
}

double RadialBasisOptions::ratio() const {
    if (radius_ratio) return *radius_ratio;
    return kernel == RadialKernel::gaussian ? 2 : kernel == RadialKernel::wendland ? 6 : 1;
}

RadialBasisMap RadialBasisMap::fit(std::span<const Point> source_mm, std::span<const Point> target_mm,
                                   const RadialBasisOptions& options, std::span<const std::string> names) {
    options.check();
    // The spline's own fit checks the points for all kernels: counts, numbers, points that coincide, a common plane.
    auto spline = ThinPlateSpline::fit(source_mm, target_mm, spline_options(options), names);
    RadialBasisMap map;
    map.kernel_ = options.kernel;
    if (!has_radius(options.kernel)) {
        map.affine_ = spline.affine();
        map.weights_.assign(spline.weights().begin(), spline.weights().end());
        map.spline_ = std::move(spline);
        return map;
    }
    const auto n = static_cast<Eigen::Index>(source_mm.size());
    const Eigen::Map<const Eigen::Matrix3Xd> source(source_mm.data()->data(), 3, n);
    const Eigen::Map<const Eigen::Matrix3Xd> target(target_mm.data()->data(), 3, n);
    // In y = (x - centre) / scale the system is well conditioned whatever the unit; of the target the mean is taken
    // off.
    const Point centre = source.rowwise().mean(), target_centre = target.rowwise().mean();
    const Eigen::Matrix3Xd centred = source.colwise() - centre;
    const double scale = std::sqrt(centred.squaredNorm() / static_cast<double>(n));
    const Eigen::Matrix3Xd y = centred / scale;
    const auto radius = radii(y, options.ratio());

    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 4, n + 4);  // Eq. 14
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            system(i, j) =
                value_of(options.kernel, (y.col(i) - y.col(j)).squaredNorm(), radius[static_cast<std::size_t>(j)]);
    system.block(0, n, n, 1).setOnes();
    system.block(0, n + 1, n, 3) = y.transpose();
    system.block(n, 0, 4, n) = system.block(0, n, n, 4).transpose();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + 4, 3);
    right.topRows(n) = (target.colwise() - target_centre).transpose();
    const Eigen::MatrixXd solution = system.partialPivLu().solve(right);
    const double off = (system * solution - right).cwiseAbs().maxCoeff();
    const double size = std::max(right.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    if (!(off <= 1e-8 * size))
        throw NumericalError(
            fmt::format("radial functions: the system of {} points is singular in double precision with kernel {} and "
                        "radius ratio {}; "
                        "give a smaller ratio, or kernel r",
                        n, to_string(options.kernel), options.ratio()));

    // Back to the given coordinates. 1 / sqrt(d^2 + r^2) has a unit, the others have none.
    const double kernel_scale = options.kernel == RadialKernel::inverse_multiquadric ? scale : 1;
    map.centres_mm_.assign(source_mm.begin(), source_mm.end());
    for (Eigen::Index i = 0; i < n; ++i) {
        map.radii_mm_.push_back(scale * radius[static_cast<std::size_t>(i)]);
        map.weights_.emplace_back(kernel_scale * solution.row(i).transpose());
    }
    map.affine_.linear() = solution.bottomRows<3>().transpose() / scale;
    map.affine_.translation() = target_centre + solution.row(n).transpose() - map.affine_.linear() * centre;
    return map;
}

Point RadialBasisMap::operator()(const Point& source_mm) const {
    if (spline_) return (*spline_)(source_mm);
    Point target_mm = affine_ * source_mm;
    for (std::size_t i = 0; i < centres_mm_.size(); ++i)
        target_mm += weights_[i] * value_of(kernel_, (source_mm - centres_mm_[i]).squaredNorm(), radii_mm_[i]);
    return target_mm;
}

void RadialBasisMap::apply(std::span<const Point> source_mm, std::span<Point> target_mm) const {
    if (source_mm.size() != target_mm.size())
        throw InputError(fmt::format("radial functions: {} points in but room for {} out; give spans of one size",
                                     source_mm.size(), target_mm.size()));
    base::parallel_for(source_mm.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) target_mm[k] = (*this)(source_mm[k]);
    });
}

}  // namespace mimik::geometry
