#include "evaluation/surface_curvature.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace mimik::evaluation {

using geometry::Point;
using geometry::Vector;

std::optional<double> mean_curvature_per_m(std::span<const Point> points_mm, const geometry::PointIndex& index,
                                           const Point& place_mm, const Vector& normal, double radius_mm) {
    constexpr std::size_t fewest_points = 12;  // twice the six unknowns
    if (!(normal.squaredNorm() > 0.5)) return std::nullopt;
    const auto around = index.within(place_mm, radius_mm);
    if (around.size() < fewest_points) return std::nullopt;
    const Vector across = normal.unitOrthogonal(), along = normal.cross(across);
    Eigen::Matrix<double, 6, 6> normal_matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (const auto& neighbour : around) {
        const Vector way = (points_mm[neighbour.index] - place_mm) / radius_mm;  // lengths near 1 keep the digits
        const double x = way.dot(across), y = way.dot(along);
        Eigen::Matrix<double, 6, 1> row;
        row << x * x, x * y, y * y, x, y, 1;
        normal_matrix += row * row.transpose();
        right += row * way.dot(normal);
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solved(normal_matrix);
    constexpr double least_pivot = 1e-9;  // of the largest: points on a line leave one at rounding
    const auto pivots = solved.vectorD().cwiseAbs();
    if (!(pivots.minCoeff() > least_pivot * pivots.maxCoeff())) return std::nullopt;
    const Eigen::Matrix<double, 6, 1> quadric = solved.solve(right);
    const double fxx = 2 * quadric[0], fxy = quadric[1], fyy = 2 * quadric[2], fx = quadric[3], fy = quadric[4];
    const double steep = 1 + fx * fx + fy * fy;
    const double upward =
        ((1 + fx * fx) * fyy - 2 * fx * fy * fxy + (1 + fy * fy) * fxx) / (2 * steep * std::sqrt(steep));
    constexpr double mm_per_m = 1000.0;
    return -upward / radius_mm * mm_per_m;
}

}  // namespace mimik::evaluation
