#include "database/landmark_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Eigenvalues>

#include "database/self_checks.h"
#include "geometry/mesh.h"
#include "geometry/statistics.h"
#include "geometry/surface_index.h"

namespace mimik::database {
namespace {

using geometry::Point;
using geometry::RangeScan;
using geometry::Triangle;
using geometry::Vector;

// A step to the next measurement that is this many times the usual one leads to another thing behind the first.
constexpr double jump_in_steps = 4.0;

std::vector<Triangle> lattice_triangles(const RangeScan& scan) {
    const auto cols = static_cast<std::uint32_t>(scan.cols), rows = static_cast<std::uint32_t>(scan.rows);
    const auto apart = [&](std::uint32_t a, std::uint32_t b) {
        return (scan.points_mm[a] - scan.points_mm[b]).squaredNorm();
    };
    std::vector<double> steps;
    for (std::uint32_t i = 0; i + 1 < rows * cols; ++i)
        if ((i + 1) % cols != 0 && scan.valid(i) && scan.valid(i + 1)) steps.push_back(apart(i, i + 1));
    const double most = jump_in_steps * jump_in_steps * geometry::upper_median(std::move(steps));
    std::vector<Triangle> triangles;
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
        for (std::uint32_t col = 0; col + 1 < cols; ++col) {
            const std::uint32_t a = row * cols + col, b = a + 1, c = b + cols, d = a + cols;
            std::vector<std::uint32_t> corners;
            for (const auto corner : {a, b, c, d})
                if (scan.valid(corner)) corners.push_back(corner);
            for (std::size_t k = 2; k < corners.size(); ++k) {
                const Triangle t = {corners[0], corners[k - 1], corners[k]};
                if (apart(t[0], t[1]) <= most && apart(t[1], t[2]) <= most && apart(t[2], t[0]) <= most)
                    triangles.push_back(t);
            }
        }
    return triangles;
}

/// Empty if there is no surface: a bare cloud, or a mesh whose faces say nothing.
std::optional<geometry::SurfaceIndex> surface_of(const RangeScan& scan) {
    auto triangles = scan.organised() ? lattice_triangles(scan) : geometry::triangulate(scan.faces);
    constexpr double farthest_mm = 1e9;  // what an index takes
    std::erase_if(triangles, [&](const Triangle& t) {
        return std::any_of(t.begin(), t.end(), [&](std::uint32_t corner) {
            const auto& p = scan.points_mm[corner];
            return !p.allFinite() || p.cwiseAbs().maxCoeff() > farthest_mm;
        });
    });
    if (triangles.empty()) return std::nullopt;
    return geometry::SurfaceIndex(scan.points_mm, triangles);
}

/// A cloud has no surface, but its points lie on one: a mark between them lies on it if it lies on their plane.
double distance_to_cloud_mm(const RangeScan& scan, const Point& mark, double to_nearest_mm) {
    constexpr std::size_t most = 12;
    std::vector<std::pair<double, std::size_t>> around;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.points_mm[i].allFinite()) around.emplace_back((scan.points_mm[i] - mark).squaredNorm(), i);
    if (around.size() < 4) return to_nearest_mm;
    const auto count = std::min(most, around.size());
    std::partial_sort(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(count), around.end());
    around.resize(count);
    Point middle = Point::Zero();
    for (const auto& [squared, i] : around) middle += scan.points_mm[i] / static_cast<double>(count);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    const Point& nearest = scan.points_mm[around.front().second];
    std::vector<double> spacing;
    for (const auto& [squared, i] : around) {
        const Vector from = scan.points_mm[i] - middle;
        spread += from * from.transpose();
        if (i != around.front().second) spacing.push_back((scan.points_mm[i] - nearest).norm());
    }
    const Vector normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
    const double height_mm = normal.dot(mark - middle);
    const double beside_mm = (mark - height_mm * normal - nearest + normal.dot(nearest - middle) * normal).norm();
    std::nth_element(spacing.begin(), spacing.begin() + 2, spacing.end());
    const double reach_mm = spacing[2];  // from a point to its third neighbour
    return std::min(to_nearest_mm, std::hypot(height_mm, std::max(0.0, beside_mm - reach_mm)));
}

}  // namespace

std::vector<double> landmark_distances_mm(const RangeScan& scan, const geometry::Landmarks& landmarks,
                                          double near_enough_mm) {
    const auto nearest = nearest_scan_points(scan, landmarks);
    std::vector<double> distances;
    for (const auto& point : nearest) distances.push_back(point.distance_mm);
    const auto far = [&](double mm) { return std::isfinite(mm) && mm > near_enough_mm; };
    if (std::none_of(distances.begin(), distances.end(), far)) return distances;
    const auto surface = surface_of(scan);
    for (std::size_t m = 0; m < distances.size(); ++m) {
        const Point& mark = landmarks.all()[m].position_mm;
        constexpr double farthest_mm = 1e9;
        if (!far(distances[m]) || !mark.allFinite() || mark.cwiseAbs().maxCoeff() > farthest_mm) continue;
        distances[m] = surface ? std::min(distances[m], surface->closest(mark).distance_mm)
                               : distance_to_cloud_mm(scan, mark, distances[m]);
    }
    return distances;
}

}  // namespace mimik::database
