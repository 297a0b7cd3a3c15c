#include "modeling/example_parameters.h"

#include <cmath>

#include <Eigen/SVD>
#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::modeling {

void ExampleParameterOptions::check() const {
    if (!(least_eigenvalue_share >= 0 && least_eigenvalue_share < 1))
        throw InputError(
            fmt::format("least_eigenvalue_share is {}; give 0 (all are kept) to less than 1", least_eigenvalue_share));
}

Eigen::VectorXd concatenated(const std::vector<geometry::Vector>& displacement_mm) {
    Eigen::VectorXd all(static_cast<Eigen::Index>(3 * displacement_mm.size()));
    for (std::size_t k = 0; k < displacement_mm.size(); ++k)
        all.segment<3>(static_cast<Eigen::Index>(3 * k)) = displacement_mm[k];
    return all;
}

ExampleParameters example_parameters(const SourceExamples& source, const ExampleParameterOptions& options) {
    options.check();
    source.check();
    const auto count = static_cast<Eigen::Index>(source.examples.size());
    const auto coordinates = static_cast<Eigen::Index>(3 * source.features.size());
    Eigen::MatrixXd points = Eigen::MatrixXd::Zero(count + 1, coordinates);  // the last is the face at rest
    for (Eigen::Index i = 0; i < count; ++i)
        points.row(i) = concatenated(source.displacement_mm[static_cast<std::size_t>(i)]).transpose();
    const Eigen::MatrixXd centred = points.rowwise() - points.colwise().mean();
    // The right singular vectors are the eigenvectors of the covariance, and there are few examples.
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centred, Eigen::ComputeThinV);
    const Eigen::VectorXd variances = svd.singularValues().cwiseAbs2() / static_cast<double>(count + 1);
    const double total = variances.sum();
    if (!(total > 0)) throw InputError("no example moves a feature; give examples that differ from the face at rest");
    constexpr double rounding = 1e-14;  // of the sum of squares of doubles
    ExampleParameters parameters;
    Eigen::Index kept = 0, known = 0;
    for (Eigen::Index k = 0; k < variances.size(); ++k) {
        if (variances[k] <= rounding * total) break;
        known = k + 1;
        if (variances[k] >= options.least_eigenvalue_share * total) kept = k + 1;
    }
    parameters.eigenvalues = variances.head(known);
    parameters.feature_matrix = svd.matrixV().leftCols(kept).transpose();
    // The sign of a singular vector is nobody's; the largest entry is positive, so that tables are stable.
    for (Eigen::Index k = 0; k < kept; ++k) {
        Eigen::Index place = 0;
        parameters.feature_matrix.row(k).cwiseAbs().maxCoeff(&place);
        if (parameters.feature_matrix(k, place) < 0) parameters.feature_matrix.row(k) *= -1;
    }
    parameters.kept_share = variances.head(kept).sum() / total;
    parameters.examples = points.topRows(count) * parameters.feature_matrix.transpose();
    double sum = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
        const double lost = (points.row(i) - parameters.examples.row(i) * parameters.feature_matrix).squaredNorm();
        sum += lost;
        const double rms = std::sqrt(lost / static_cast<double>(coordinates));
        if (rms > parameters.largest_loss_rms_mm) {
            parameters.largest_loss_rms_mm = rms;
            parameters.largest_loss_example = static_cast<std::size_t>(i);
        }
    }
    parameters.loss_rms_mm = std::sqrt(sum / static_cast<double>(coordinates * count));
    return parameters;
}

}  // namespace mimik::modeling
