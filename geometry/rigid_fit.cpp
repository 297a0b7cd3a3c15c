#include "geometry/rigid_fit.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::geometry {

std::optional<Transform> rigid_fit(std::span<const Point> source, std::span<const Point> target,
                                   std::span<const double> weights) {
    if (source.size() != target.size() || (!weights.empty() && weights.size() != source.size()))
        throw InputError(fmt::format("rigid fit: {} source and {} target points with {} weights; pair them one to one",
                                     source.size(), target.size(), weights.size()));
    const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
    double sum = 0;
    std::size_t used = 0;
    Point source_centre = Point::Zero(), target_centre = Point::Zero();
    for (std::size_t i = 0; i < source.size(); ++i) {
        if (!(weight(i) > 0)) continue;
        ++used;
        sum += weight(i);
        source_centre += weight(i) * source[i];
        target_centre += weight(i) * target[i];
    }
    if (used < 3) return std::nullopt;
    source_centre /= sum;
    target_centre /= sum;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < source.size(); ++i) {
        if (!(weight(i) > 0)) continue;
        const Vector from = source[i] - source_centre;
        covariance += weight(i) * (target[i] - target_centre) * from.transpose();
        spread += weight(i) * from * from.transpose();
    }
    const Eigen::Vector3d variances =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
    const double thinnest = thinnest_ratio_of_rigid_fit * thinnest_ratio_of_rigid_fit;
    if (!(variances[1] > thinnest * variances[2])) return std::nullopt;  // one line, one point, or no number

    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs[2] = -1;
    Transform target_from_source = Transform::Identity();
    target_from_source.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    target_from_source.translation() = target_centre - target_from_source.linear() * source_centre;
    return target_from_source;
}

}  // namespace mimik::geometry
