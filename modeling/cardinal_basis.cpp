#include "modeling/cardinal_basis.h"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::modeling {

void CardinalBasisOptions::check() const {
    if (!(ridge_share >= 0 && ridge_share <= 1))
        throw InputError(fmt::format("ridge_share is {}; give 0 (plain least squares) to 1", ridge_share));
}

double cubic_b_spline(double x) {
    x = std::abs(x);
    if (x >= 2) return 0;
    if (x >= 1) return (2 - x) * (2 - x) * (2 - x) / 6;
    return 2.0 / 3.0 - x * x + x * x * x / 2;
}

namespace {

std::string example_text(Eigen::Index k, Eigen::Index examples) {
    return k == examples ? std::string("the face at rest") : fmt::format("example {}", k);
}

/// The distance of every centre to the nearest other one.
Eigen::VectorXd separations(const Eigen::MatrixXd& centres, Eigen::Index examples) {
    Eigen::VectorXd nearest = Eigen::VectorXd::Constant(centres.rows(), std::numeric_limits<double>::infinity());
    const double size = std::sqrt(centres.rowwise().squaredNorm().maxCoeff());
    for (Eigen::Index i = 0; i < centres.rows(); ++i)
        for (Eigen::Index j = 0; j < centres.rows(); ++j) {
            if (i == j) continue;
            const double distance = (centres.row(i) - centres.row(j)).norm();
            if (distance <= 1e-9 * size)
                throw InputError(
                    fmt::format("{} and {} move the features alike; leave one out, or follow features "
                                "that tell them apart",
                                example_text(std::min(i, j), examples), example_text(std::max(i, j), examples)));
            nearest[i] = std::min(nearest[i], distance);
        }
    return nearest;
}

/// Least squares of smallest norm about the constant: the hyperplane of Eq. 9 for every example.
Eigen::MatrixXd hyperplanes(const Eigen::MatrixXd& centres, const Eigen::MatrixXd& wanted, double ridge_share) {
    const Eigen::RowVectorXd mean = centres.colwise().mean(), wanted_mean = wanted.colwise().mean();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centres.rowwise() - mean, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const auto& values = svd.singularValues();
    const double largest = values.size() > 0 ? values[0] : 0;
    Eigen::VectorXd inverse = Eigen::VectorXd::Zero(values.size());
    for (Eigen::Index k = 0; k < values.size(); ++k)
        if (values[k] > 1e-12 * largest)
            inverse[k] = values[k] / (values[k] * values[k] + ridge_share * largest * largest);
    Eigen::MatrixXd linear(centres.cols() + 1, wanted.cols());
    linear.bottomRows(centres.cols()) =
        svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose() * (wanted.rowwise() - wanted_mean);
    linear.row(0) = wanted_mean - mean * linear.bottomRows(centres.cols());
    return linear;
}

}  // namespace

CardinalBasis::CardinalBasis(const Eigen::MatrixXd& examples, const CardinalBasisOptions& options) {
    options.check();
    const auto count = examples.rows(), all = count + (options.with_rest ? 1 : 0);
    if (count == 0) throw InputError("there is no example; give at least one");
    if (!examples.allFinite()) throw InputError("an example's place in the parameter space is not finite");
    centres_ = Eigen::MatrixXd::Zero(all, examples.cols());
    centres_.topRows(count) = examples;
    if (all == 1) {  // a single example with nothing to tell it from
        dilations_ = Eigen::VectorXd::Ones(1);
    } else {
        dilations_ = separations(centres_, count);
    }
    Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(all, count);
    wanted.topRows(count).setIdentity();
    linear_ = hyperplanes(centres_, wanted, options.ridge_share);
    const Eigen::MatrixXd residuals =
        wanted - ((centres_ * linear_.bottomRows(centres_.cols())).rowwise() + linear_.row(0));
    largest_residual_ = residuals.cwiseAbs().maxCoeff();
    Eigen::MatrixXd basis(all, all);  // R_ij of Eq. 12: row of the place, column of the centre
    for (Eigen::Index i = 0; i < all; ++i)
        for (Eigen::Index j = 0; j < all; ++j)
            basis(i, j) = cubic_b_spline((centres_.row(i) - centres_.row(j)).norm() / dilations_[j]);
    const Eigen::JacobiSVD<Eigen::MatrixXd> judge(basis);
    const auto& values = judge.singularValues();
    condition_ = values[0] / values[values.size() - 1];
    if (!(condition_ < 1e10))
        throw NumericalError(
            fmt::format("the radial parts of the examples cannot be told apart (condition {:.2g}); leave examples out",
                        condition_));
    radial_ = basis.partialPivLu().solve(residuals);
}

Eigen::VectorXd CardinalBasis::weights(const Eigen::VectorXd& parameters) const {
    Eigen::VectorXd weights = linear_.row(0).transpose() + linear_.bottomRows(centres_.cols()).transpose() * parameters;
    for (Eigen::Index j = 0; j < centres_.rows(); ++j) {
        const double near = cubic_b_spline((centres_.row(j).transpose() - parameters).norm() / dilations_[j]);
        if (near > 0) weights += near * radial_.row(j).transpose();
    }
    return weights;
}

}  // namespace mimik::modeling
