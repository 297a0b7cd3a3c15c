#include "statistics/variance_components.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "base/errors.h"
#include "statistics/clusters.h"
#include "statistics/distributions.h"
#include "statistics/values.h"

namespace mimik::statistics {
namespace {

/// The values as a table of sums and counts.
struct Table {
    Eigen::MatrixXd counts;                // source by target
    Eigen::VectorXd of_source, of_target;  // sums of the values
    double squares = 0;                    // of all values, about their mean
};

Table tabulate(std::span<const double> values, double mean, const DenseIds& source, const DenseIds& target) {
    Table table;
    table.counts =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(source.count), static_cast<Eigen::Index>(target.count));
    table.of_source = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(source.count));
    table.of_target = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(target.count));
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Eigen::Index i = source.of_case[k], j = target.of_case[k];
        table.counts(i, j) += 1;
        table.of_source(i) += values[k] - mean;
        table.of_target(j) += values[k] - mean;
    }
    table.squares = squares_about(values, mean);
    return table;
}

/// What a factor explains that the other does not.
struct Fitted {
    double squares = 0;
    Eigen::Index degrees = 0;
    double weight = 0;  // of the factor's variance in the expected squares
};

/// The first factor (rows of `counts`) after the second. The second is eliminated from the normal equations.
Fitted fit_after(const Eigen::MatrixXd& counts, const Eigen::VectorXd& sums, const Eigen::VectorXd& other_sums) {
    const Eigen::VectorXd rows = counts.rowwise().sum();
    const Eigen::VectorXd columns = counts.colwise().sum();
    const Eigen::MatrixXd scaled = counts * columns.cwiseInverse().asDiagonal();
    Eigen::MatrixXd normal = -scaled * counts.transpose();
    normal.diagonal() += rows;
    const Eigen::VectorXd right = sums - scaled * other_sums;
    // Rank below full by the parts into which the table falls. Weights are whole numbers: what is 0 is far from 1.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-9);
    solver.compute(normal);
    Fitted fitted;
    fitted.degrees = solver.rank();
    fitted.squares = right.dot(solver.solve(right));
    fitted.weight = normal.trace();
    return fitted;
}

VarianceComponent component(const Fitted& fitted, double residual, double residual_degrees) {
    VarianceComponent result;
    const auto degrees = static_cast<double>(fitted.degrees);
    result.variance = (fitted.squares - degrees * residual) / fitted.weight;
    result.degrees = static_cast<std::size_t>(fitted.degrees);
    result.f = std::max(0.0, fitted.squares / degrees / residual);
    result.p = fisher_above(result.f, degrees, residual_degrees);
    return result;
}

}  // namespace

VarianceComponents variance_components(std::span<const double> values, std::span<const std::uint32_t> source,
                                       std::span<const std::uint32_t> target) {
    if (source.size() != values.size() || target.size() != values.size())
        throw InputError(
            fmt::format("shares of variance of {} values, {} sources and {} targets; give one of each per "
                        "value",
                        values.size(), source.size(), target.size()));
    need_values(values, 1, "shares of variance");
    VarianceComponents result;
    result.cells = values.size();
    result.mean = mean_of(values);
    const auto table = tabulate(values, result.mean, dense_ids(source), dense_ids(target));
    const auto of_source = fit_after(table.counts, table.of_source, table.of_target);
    const auto of_target = fit_after(table.counts.transpose(), table.of_target, table.of_source);
    const Eigen::Index degrees =
        static_cast<Eigen::Index>(values.size()) - table.counts.cols() - of_source.degrees;  // the mean is a target's
    if (of_source.degrees < 1 || of_target.degrees < 1 || degrees < 1)
        throw NumericalError(fmt::format(
            "shares of variance: {} values of {} sources and {} targets do not tell the two apart; add pairs",
            values.size(), table.counts.rows(), table.counts.cols()));
    // Squares of the targets alone, then of the sources after them.
    const double explained =
        table.of_target.cwiseAbs2().dot(table.counts.colwise().sum().transpose().cwiseInverse()) + of_source.squares;
    const double squares = table.squares - explained;
    if (!(squares > 1e-24 * squares_about(values, 0)))  // squares of what rounding leaves
        throw NumericalError("shares of variance of values without a residual have no test; give measured values");
    result.residual.variance = squares / static_cast<double>(degrees);
    result.residual.degrees = static_cast<std::size_t>(degrees);
    result.source = component(of_source, result.residual.variance, static_cast<double>(degrees));
    result.target = component(of_target, result.residual.variance, static_cast<double>(degrees));
    double sum = 0;
    for (auto* one : {&result.source, &result.target, &result.residual}) sum += std::max(0.0, one->variance);
    for (auto* one : {&result.source, &result.target, &result.residual})
        one->share = std::max(0.0, one->variance) / sum;
    return result;
}

}  // namespace mimik::statistics
