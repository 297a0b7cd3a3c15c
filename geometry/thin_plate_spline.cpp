#include "geometry/thin_plate_spline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"
#include "geometry/cholesky_simd.h"
#include "geometry/thin_plate_spline_simd.h"

namespace mimik::geometry {
namespace {

static_assert(sizeof(Point) == 3 * sizeof(double), "points in a row are numbers in a row");
const double* numbers(const Point* points) { return reinterpret_cast<const double*>(points); }
double* numbers(Point* points) { return reinterpret_cast<double*>(points); }

constexpr std::size_t points_per_piece = 1024;  // 30 us of work at 40 controls

double kernel_value(SplineKernel kernel, double squared_distance) {
    if (kernel == SplineKernel::r) return -std::sqrt(squared_distance);
    return squared_distance > 0 ? squared_distance * std::log(squared_distance) : 0.0;
}

/// U'(r) / r: the gradient of U is this times the difference of the points.
double kernel_slope_over_distance(SplineKernel kernel, double squared_distance) {
    if (squared_distance == 0) return 0;  // r: mean over all directions; r^2 ln r^2: the limit of the gradient
    if (kernel == SplineKernel::r) return -1 / std::sqrt(squared_distance);
    return 2 * std::log(squared_distance) + 2;
}

std::string point_name(std::span<const std::string> names, std::size_t i) {
    return names.empty() ? fmt::format("point {}", i) : fmt::format("'{}'", names[i]);
}

std::string listed_names(std::span<const std::string> names, std::size_t count) {
    constexpr std::size_t shown = 12;
    std::vector<std::string> list;
    for (std::size_t i = 0; i < std::min(count, shown); ++i) list.push_back(point_name(names, i));
    return fmt::format("{}{}", fmt::join(list, ", "),
                       count > shown ? fmt::format(" and {} more", count - shown) : std::string());
}

void check_input(std::span<const Point> source_mm, std::span<const Point> target_mm,
                 std::span<const std::string> names) {
    if (source_mm.size() != target_mm.size())
        throw InputError(fmt::format("thin-plate spline: {} but {} target points; pair them one to one",
                                     base::counted(source_mm.size(), "source point"), target_mm.size()));
    if (!names.empty() && names.size() != source_mm.size())
        throw InputError(fmt::format("thin-plate spline: {} for {} points; give one name per point, or none",
                                     base::counted(names.size(), "name"), source_mm.size()));
    if (source_mm.size() < 4)
        throw InputError(fmt::format("thin-plate spline: {}, and it needs at least 4; add pairs",
                                     base::counted(source_mm.size(), "point pair")));
    for (std::size_t i = 0; i < source_mm.size(); ++i)
        if (!source_mm[i].allFinite() || !target_mm[i].allFinite())
            throw InputError(
                fmt::format("thin-plate spline: the {} of {} has a coordinate that is not a finite number; "
                            "mark the point again or leave the pair out",
                            source_mm[i].allFinite() ? "target" : "source", point_name(names, i)));
}

struct ClosePair {
    std::size_t first = 0, second = 0;
    double distance_mm = 0;
};

/// The closest two points among those that are closer than `below_mm`. Sorted along x, so that few pairs are looked at.
std::optional<ClosePair> closest_pair(std::span<const Point> points_mm, double below_mm) {
    std::vector<std::size_t> order(points_mm.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return points_mm[a].x() < points_mm[b].x() || (points_mm[a].x() == points_mm[b].x() && a < b);
    });
    std::optional<ClosePair> closest;
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const auto a = order[i], b = order[j];
            if (points_mm[b].x() - points_mm[a].x() >= below_mm) break;
            const double distance = (points_mm[a] - points_mm[b]).norm();
            if (distance >= below_mm) continue;
            below_mm = distance;
            closest = ClosePair{std::min(a, b), std::max(a, b), distance};
            if (distance == 0) return closest;
        }
    return closest;
}

/// What double precision cannot tell from a plane or a point is refused whatever the options say.
constexpr double thinnest_ratio = 1e-12;

void check_spread(std::span<const Point> source_mm, const Point& centre_mm, double radius_mm,
                  const ThinPlateSplineOptions& options, std::span<const std::string> names) {
    const double least_separation_mm =
        std::max(options.min_separation_ratio * radius_mm, std::numeric_limits<double>::min());
    const double least_thickness_mm = std::max(options.min_thickness_ratio, thinnest_ratio) * radius_mm;
    if (const auto pair = closest_pair(source_mm, least_separation_mm))
        throw NumericalError(fmt::format(
            "thin-plate spline: the source points {} and {} lie {:.3g} mm apart (least allowed: {:.3g} mm); "
            "leave one of the two out",
            point_name(names, pair->first), point_name(names, pair->second), pair->distance_mm, least_separation_mm));
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& s : source_mm) scatter += (s - centre_mm) * (s - centre_mm).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
    const Vector normal = axes.eigenvectors().col(0);
    const Vector along = axes.eigenvectors().col(2);
    double off_plane_mm = 0, off_line_mm = 0;
    for (const auto& s : source_mm) {
        off_plane_mm = std::max(off_plane_mm, std::abs(normal.dot(s - centre_mm)));
        off_line_mm = std::max(off_line_mm, along.cross(s - centre_mm).norm());
    }
    if (off_line_mm < least_thickness_mm)
        throw NumericalError(
            fmt::format("thin-plate spline: all {} source points ({}) lie within {:.3g} mm of one line "
                        "(least allowed: {:.3g} mm); add points off it",
                        source_mm.size(), listed_names(names, source_mm.size()), off_line_mm, least_thickness_mm));
    if (off_plane_mm < least_thickness_mm)
        throw NumericalError(
            fmt::format("thin-plate spline: all {} source points ({}) lie within {:.3g} mm of one plane "
                        "(normal {:.3f}, {:.3f}, {:.3f}; least allowed: {:.3g} mm); add a point off it",
                        source_mm.size(), listed_names(names, source_mm.size()), off_plane_mm, normal.x(), normal.y(),
                        normal.z(), least_thickness_mm));
}

using FourColumns = Eigen::Matrix<double, Eigen::Dynamic, 4>;

/// P = Q [R; 0] for P = [1 y^T], with the four reflections of Q at once: Q = I - H T H^T.
struct AffineReflection {
    FourColumns H;
    Eigen::Matrix4d T = Eigen::Matrix4d::Zero();
    Eigen::Matrix4d R;

    explicit AffineReflection(const Eigen::Matrix3Xd& y) : H(y.cols(), 4) {
        H.col(0).setOnes();
        H.rightCols<3>() = y.transpose();
        const Eigen::HouseholderQR<FourColumns> qr(H);
        H = qr.matrixQR();
        R = H.topRows<4>();
        H.topRows<4>().triangularView<Eigen::Upper>().setZero();
        H.topRows<4>().diagonal().setOnes();
        for (Eigen::Index i = 0; i < 4; ++i) {
            const double tau = qr.hCoeffs()[i];
            T.col(i).head(i) = -tau * (T.topLeftCorner(i, i) * (H.leftCols(i).transpose() * H.col(i)));
            T(i, i) = tau;
        }
    }
};

}  // namespace

void ThinPlateSplineOptions::check() const {
    if (!(smoothing >= 0) || !std::isfinite(smoothing))
        throw InputError(fmt::format("smoothing is {}; give 0 or more", smoothing));
    for (const auto& [field, value] : {std::pair{"min_separation_ratio", min_separation_ratio},
                                       std::pair{"min_thickness_ratio", min_thickness_ratio}})
        if (!(value >= 0 && value < 1))
            throw InputError(fmt::format("{} is {}; give 0 or more, and less than 1", field, value));
}

ThinPlateSpline ThinPlateSpline::fit(std::span<const Point> source_mm, std::span<const Point> target_mm,
                                     const ThinPlateSplineOptions& options, std::span<const std::string> names) {
    options.check();
    check_input(source_mm, target_mm, names);
    const auto n = static_cast<Eigen::Index>(source_mm.size());
    const Eigen::Map<const Eigen::Matrix3Xd> source(source_mm.data()->data(), 3, n);
    const Eigen::Map<const Eigen::Matrix3Xd> target(target_mm.data()->data(), 3, n);
    const Point centre = source.rowwise().mean();
    const Eigen::Matrix3Xd centred = source.colwise() - centre;
    const double scale = std::sqrt(centred.squaredNorm() / static_cast<double>(n));
    check_spread(source_mm, centre, scale, options, names);

    // In y = (x - centre) / scale the system is well conditioned whatever the unit. K scales by scale (r) or scale^2
    // (r^2 ln r^2; the term ln(scale^2) |x - s_i|^2 sums to a constant under the side conditions), and X with it.
    const Eigen::Matrix3Xd y = centred / scale;
    const double kernel_scale = options.kernel == SplineKernel::r ? scale : scale * scale;
    // Displacements, not positions, decide the digits: the mean is taken off.
    const Point target_centre = target.rowwise().mean();

    // The lower triangle of K, and below it V^T: factoring K then solves for V on the way.
    const auto stride = static_cast<Eigen::Index>(simd::cholesky_stride(static_cast<std::size_t>(n + 3)));
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(stride, n);
    for (Eigen::Index j = 0; j < n; ++j)
        simd::kernel_values(options.kernel, y.col(j).data(), y.col(j).data(), &system(j, j),
                            static_cast<std::size_t>(n - j));
    auto K = system.topRows(n);
    auto Vt = system.middleRows<3>(n);
    Vt = target.colwise() - target_centre;

    // P = Q [R; 0]. With W = Q [0; Z] the side conditions hold, and what is left is positive definite:
    // (Q2^T K Q2 + X I) Z = Q2^T V, then R A = Q1^T (V - K W).
    const AffineReflection q(y);
    const FourColumns KHT = (K.selfadjointView<Eigen::Lower>() * q.H) * q.T;
    const FourColumns G = KHT - q.H * (0.5 * (q.T.transpose() * (q.H.transpose() * KHT)));
    Eigen::Matrix<double, Eigen::Dynamic, 8> left(n, 8), right(n, 8);
    left << q.H, G;
    right << G, q.H;
    K.triangularView<Eigen::Lower>() -= left * right.transpose();  // Q^T K Q = K - H G^T - G H^T
    Vt -= ((Vt * q.H) * q.T) * q.H.transpose();

    const Eigen::Index rest = n - 4;
    Eigen::MatrixXd W = Eigen::MatrixXd::Zero(n, 3);
    if (rest > 0) {
        auto reduced = system.bottomRightCorner(stride - 4, rest);
        const double least_pivot = 16 * static_cast<double>(n) * std::numeric_limits<double>::epsilon() *
                                   reduced.diagonal().cwiseAbs().maxCoeff();
        reduced.diagonal().array() += options.smoothing / kernel_scale;
        if (!simd::factor_cholesky(&reduced(0, 0), static_cast<std::size_t>(rest + 3), static_cast<std::size_t>(rest),
                                   static_cast<std::size_t>(stride), least_pivot)) {
            const auto pair = closest_pair(source_mm, std::numeric_limits<double>::infinity());
            throw NumericalError(
                fmt::format("thin-plate spline: the system of {} points is singular in double precision; the "
                            "closest two, {} and {}, lie {:.3g} mm apart; leave one out or add smoothing",
                            n, point_name(names, pair->first), point_name(names, pair->second), pair->distance_mm));
        }
        Eigen::MatrixXd Z = Vt.rightCols(rest).transpose();
        reduced.topRows(rest).triangularView<Eigen::Lower>().transpose().solveInPlace(Z);
        W.bottomRows(rest) = Z;
    }
    const Eigen::Matrix<double, 4, 3> top =
        Vt.leftCols<4>().transpose() - K.bottomLeftCorner(rest, 4).transpose() * W.bottomRows(rest);
    Eigen::Matrix<double, 4, 3> A = q.R.triangularView<Eigen::Upper>().solve(top);
    W -= q.H * (q.T * (q.H.transpose() * W)).eval();

    // Back to the given coordinates.
    if (options.kernel == SplineKernel::r2_log_r2)
        A.row(0) -= std::log(scale * scale) * (y.colwise().squaredNorm() * W);
    ThinPlateSpline spline;
    spline.kernel_ = options.kernel;
    spline.centres_mm_.assign(source_mm.begin(), source_mm.end());
    spline.weights_.resize(source_mm.size());
    for (Eigen::Index i = 0; i < n; ++i)
        spline.weights_[static_cast<std::size_t>(i)] = W.row(i).transpose() / kernel_scale;
    spline.affine_.linear() = A.bottomRows<3>().transpose() / scale;
    spline.affine_.translation() = target_centre + A.row(0).transpose() - spline.affine_.linear() * centre;
    return spline;
}

Point ThinPlateSpline::operator()(const Point& source_mm) const {
    Point target_mm;
    evaluate(&source_mm, &target_mm, 1);
    return target_mm;
}

void ThinPlateSpline::evaluate(const Point* source_mm, Point* target_mm, std::size_t count) const {
    const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> affine = affine_.matrix().topRows<3>();
    const simd::SplineTerms terms{kernel_, numbers(centres_mm_.data()), numbers(weights_.data()), centres_mm_.size(),
                                  affine.data()};
    simd::evaluate_spline(terms, numbers(source_mm), numbers(target_mm), count);
}

void ThinPlateSpline::apply(std::span<const Point> source_mm, std::span<Point> target_mm) const {
    if (source_mm.size() != target_mm.size())
        throw InputError(fmt::format("thin-plate spline: {} points in but room for {} out; give spans of one size",
                                     source_mm.size(), target_mm.size()));
    base::parallel_for(source_mm.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
        evaluate(source_mm.data() + begin, target_mm.data() + begin, end - begin);
    });
}

std::vector<Point> ThinPlateSpline::apply(std::span<const Point> source_mm) const {
    std::vector<Point> target_mm(source_mm.size());
    apply(source_mm, target_mm);
    return target_mm;
}

Eigen::Matrix3d ThinPlateSpline::derivative(const Point& source_mm) const {
    Eigen::Matrix3d jacobian = affine_.linear();
    for (std::size_t i = 0; i < centres_mm_.size(); ++i) {
        const Vector offset = source_mm - centres_mm_[i];
        jacobian += weights_[i] * (kernel_slope_over_distance(kernel_, offset.squaredNorm()) * offset).transpose();
    }
    return jacobian;
}

double ThinPlateSpline::bending_energy() const {
    double energy = 0;
    for (std::size_t i = 0; i < centres_mm_.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            energy += 2 * weights_[i].dot(weights_[j]) *
                      kernel_value(kernel_, (centres_mm_[i] - centres_mm_[j]).squaredNorm());
    return std::max(0.0, energy);  // rounding may leave -1e-20 where nothing bends
}

}  // namespace mimik::geometry
