#include "capture/cylindrical_projection.h"

#include <cmath>

#include <Eigen/Dense>

namespace mimik::capture {

using geometry::Point;
using geometry::SurfacePoint;
using geometry::Vector;

std::optional<HeadCylinder> head_cylinder(std::span<const Point> points_mm, const Vector& up) {
    if (points_mm.size() < 3) return std::nullopt;
    const Vector axis = up.normalized();
    const Vector first = axis.unitOrthogonal(), second = axis.cross(first);
    Point centre = Point::Zero();
    for (const auto& p : points_mm) centre += p / static_cast<double>(points_mm.size());
    // u^2 + v^2 = 2 a u + 2 b v + c: linear in the middle (a, b) of a circle.
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(points_mm.size()), 3);
    Eigen::VectorXd squares(rows.rows());
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
        const Vector from = points_mm[static_cast<std::size_t>(k)] - centre;
        const double u = from.dot(first), v = from.dot(second);
        rows.row(k) << 2 * u, 2 * v, 1;
        squares[k] = u * u + v * v;
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(rows);
    solver.setThreshold(1e-6);
    if (solver.rank() < 3) return std::nullopt;
    const Eigen::Vector3d circle = solver.solve(squares);
    return HeadCylinder{centre + circle[0] * first + circle[1] * second, axis,
                        std::sqrt(std::max(0.0, circle[2] + circle.head<2>().squaredNorm()))};
}

Vector away_from_axis(const HeadCylinder& cylinder, const Point& point_mm) {
    const Vector from_axis = point_mm - cylinder.on_axis_mm;
    return from_axis - from_axis.dot(cylinder.up) * cylinder.up;
}

std::optional<SurfacePoint> project_from_axis(const HeadCylinder& cylinder, const Point& point_mm,
                                              const geometry::SurfaceIndex& surface, double most_mm) {
    const Vector level = away_from_axis(cylinder, point_mm);
    const double length = level.norm();
    if (!(length > 0)) return std::nullopt;
    const Vector outwards = level / length;
    std::optional<SurfacePoint> best;
    double best_mm = most_mm;
    for (const double way : {1.0, -1.0}) {
        SurfacePoint hit;
        if (!surface.first_hit(point_mm, way * outwards, hit)) continue;
        const auto& t = surface.triangles()[hit.triangle];
        const auto at = surface.vertices_mm();
        // The skin, and not the inner side of what lies behind it.
        const bool from_within = (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).dot(outwards) > 0;
        const double away_mm = (hit.position_mm - point_mm).norm();
        if (!from_within || away_mm > best_mm) continue;
        best = hit;
        best_mm = away_mm;
    }
    return best;
}

}  // namespace mimik::capture
