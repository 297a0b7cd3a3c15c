#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "geometry/landmarks.h"

namespace mimik::test {

/// Eqs 4.11-4.19 of the thesis as they stand, solved densely in long double: kernel r^2 ln r^2 through every point.
class DenseSpline {
public:
    DenseSpline(std::span<const geometry::Point> from, std::span<const geometry::Point> to) {
        const auto n = static_cast<Eigen::Index>(from.size());
        from_.resize(n, 3);
        Matrix system = Matrix::Zero(n + 4, n + 4), right = Matrix::Zero(n + 4, 3);
        for (Eigen::Index i = 0; i < n; ++i) {
            from_.row(i) = from[static_cast<std::size_t>(i)].cast<long double>().transpose();
            right.row(i) = to[static_cast<std::size_t>(i)].cast<long double>().transpose();
        }
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index j = 0; j < n; ++j) system(i, j) = u((from_.row(i) - from_.row(j)).squaredNorm());
            system(i, n) = system(n, i) = 1;
            for (Eigen::Index k = 0; k < 3; ++k) system(i, n + 1 + k) = system(n + 1 + k, i) = from_(i, k);
        }
        solution_ = system.fullPivLu().solve(right);
    }
    /// Between the landmarks of the same name.
    static DenseSpline between(const geometry::Landmarks& from, const geometry::Landmarks& to) {
        std::vector<geometry::Point> a, b;
        for (const auto& mark : from.all())
            if (const auto* other = to.find(mark.name)) {
                a.push_back(mark.position_mm);
                b.push_back(other->position_mm);
            }
        return {a, b};
    }
    [[nodiscard]] geometry::Point operator()(const geometry::Point& at) const {
        const Eigen::Matrix<long double, 1, 3> x = at.cast<long double>().transpose();
        const auto n = from_.rows();
        Eigen::Matrix<long double, 1, 3> f = solution_.row(n) + x * solution_.bottomRows(3);
        for (Eigen::Index i = 0; i < n; ++i) f += u((x - from_.row(i)).squaredNorm()) * solution_.row(i);
        return f.transpose().cast<double>();
    }

private:
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    static long double u(long double r2) { return r2 > 0 ? r2 * std::log(r2) : 0.0L; }
    Matrix from_, solution_;
};

}  // namespace mimik::test
