#include "geometry/deformation_transfer.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/disjoint_sets.h"
#include "geometry/vertex_mask.h"

namespace mimik::geometry {

using Sparse = Eigen::SparseMatrix<double>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

namespace {

/// Two edges and the way to the fourth vertex. @throws NumericalError if they span nothing.
Eigen::Matrix3d edges(const Point& a, const Point& b, const Point& c, std::size_t triangle) {
    const Vector across = (b - a).cross(c - a);
    const double twice_area = across.norm();
    if (!(twice_area > 0) || !std::isfinite(twice_area))
        throw NumericalError(
            fmt::format("triangle {} has no area, so nobody can say how it is deformed; mend the mesh", triangle));
    Eigen::Matrix3d columns;
    columns << b - a, c - a, across / std::sqrt(twice_area);
    return columns;
}

/// g of T = sum over the corners of x g^T, within the triangle's plane: the fourth vertex takes what lies across it.
std::array<Vector, 3> gradients_of_corners(const Point& a, const Point& b, const Point& c, std::size_t triangle) {
    const Eigen::Matrix3d inverse = edges(a, b, c, triangle).inverse();
    const Vector of_b = inverse.row(0), of_c = inverse.row(1);
    return {-(of_b + of_c), of_b, of_c};
}

void expect_size(std::size_t got, std::size_t wanted, const char* what) {
    if (got != wanted)
        throw InputError(fmt::format("deformation transfer: {} {}, {} wanted: source and target need the same mesh",
                                     got, what, wanted));
}

}  // namespace

std::vector<Eigen::Matrix3d> deformation_gradients(std::span<const Point> rest_mm, std::span<const Vector> motion_mm,
                                                   std::span<const Triangle> triangles) {
    expect_size(motion_mm.size(), rest_mm.size(), "motions");
    std::vector<Eigen::Matrix3d> gradients;
    gradients.reserve(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto [a, b, c] = triangles[t];
        const auto moved = [&](std::uint32_t v) { return Point(rest_mm[v] + motion_mm[v]); };
        gradients.emplace_back(edges(moved(a), moved(b), moved(c), t) *
                               edges(rest_mm[a], rest_mm[b], rest_mm[c], t).inverse());
    }
    return gradients;
}

void DeformationTransferOptions::check() const {
    if (!(anchor_weight > 0 && std::isfinite(anchor_weight)))
        throw InputError(fmt::format("anchor_weight is {}; give more than 0", anchor_weight));
}

struct DeformationTransferMesh::Parts {
    std::size_t vertices = 0;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> anchors;
    VertexMask used;
    DeformationTransferOptions options;
    std::vector<int> row;  ///< of each vertex, so that the factor stays sparse

    void check_pieces() const {
        DisjointSets pieces(vertices);
        for (const auto& [a, b, c] : triangles) {
            pieces.join(a, b);
            pieces.join(a, c);
        }
        VertexMask held(vertices, 0);
        for (const auto v : anchors) held[pieces.root(v)] = 1;
        for (std::uint32_t v = 0; v < vertices; ++v)
            if (used[v] && !held[pieces.root(v)])
                throw InputError(
                    fmt::format("deformation transfer: the piece of vertex {} has no anchor; gradients alone do not "
                                "say where it is",
                                v));
    }

    /// By approximate minimum degree: which entries there are depends on the triangles alone.
    void find_order() {
        std::vector<Eigen::Triplet<double>> entries;
        for (int v = 0; v < static_cast<int>(vertices); ++v) entries.emplace_back(v, v, 1.0);
        for (const auto& triangle : triangles)
            for (const auto a : triangle)
                for (const auto b : triangle)
                    if (a != b) entries.emplace_back(static_cast<int>(a), static_cast<int>(b), 1.0);
        Sparse pattern(static_cast<Eigen::Index>(vertices), static_cast<Eigen::Index>(vertices));
        pattern.setFromTriplets(entries.begin(), entries.end());
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
        Eigen::AMDOrdering<int>()(pattern, inverse);
        row.assign(vertices, 0);
        for (int k = 0; k < static_cast<int>(vertices); ++k) row[static_cast<std::size_t>(inverse.indices()[k])] = k;
    }
};

DeformationTransferMesh::DeformationTransferMesh(std::size_t vertices, std::vector<Triangle> triangles,
                                                 std::vector<std::uint32_t> anchors,
                                                 const DeformationTransferOptions& options) {
    options.check();
    if (triangles.empty()) throw InputError("deformation transfer: there is no triangle");
    auto parts = std::make_shared<Parts>();
    parts->vertices = vertices;
    parts->triangles = std::move(triangles);
    parts->anchors = std::move(anchors);
    parts->used.assign(vertices, 0);
    parts->options = options;
    const auto check = [&](std::uint32_t v) {
        if (v >= vertices)
            throw InputError(fmt::format("deformation transfer: vertex {} of {} is not there", v, vertices));
    };
    for (const auto v : parts->anchors) check(v);
    for (const auto& triangle : parts->triangles)
        for (const auto v : triangle) {
            check(v);
            parts->used[v] = 1;
        }
    parts->check_pieces();
    parts->find_order();
    parts_ = std::move(parts);
}

std::size_t DeformationTransferMesh::size() const { return parts_->vertices; }
std::span<const Triangle> DeformationTransferMesh::triangles() const { return parts_->triangles; }
std::span<const std::uint32_t> DeformationTransferMesh::anchors() const { return parts_->anchors; }

struct DeformationTransfer::Factor {
    std::vector<std::array<Vector, 3>> corners;  ///< of each triangle
    Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> ldlt;
};

DeformationTransfer::DeformationTransfer(DeformationTransferMesh mesh, std::span<const Point> rest_mm)
    : mesh_(std::move(mesh)) {
    const auto& parts = *mesh_.parts_;
    expect_size(rest_mm.size(), parts.vertices, "vertices");
    auto factor = std::make_shared<Factor>();
    factor->corners.reserve(parts.triangles.size());
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(6 * parts.triangles.size() + parts.vertices);
    for (std::size_t t = 0; t < parts.triangles.size(); ++t) {
        const auto& triangle = parts.triangles[t];
        const auto& g = factor->corners.emplace_back(
            gradients_of_corners(rest_mm[triangle[0]], rest_mm[triangle[1]], rest_mm[triangle[2]], t));
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t m = 0; m < 3; ++m) {
                const int r = parts.row[triangle[k]], c = parts.row[triangle[m]];
                if (c <= r) entries.emplace_back(r, c, g[k].dot(g[m]));
            }
    }
    for (const auto v : parts.anchors) entries.emplace_back(parts.row[v], parts.row[v], parts.options.anchor_weight);
    for (std::size_t v = 0; v < parts.vertices; ++v)
        if (!parts.used[v]) entries.emplace_back(parts.row[v], parts.row[v], 1.0);
    const auto size = static_cast<Eigen::Index>(parts.vertices);
    Sparse system(size, size);
    system.setFromTriplets(entries.begin(), entries.end());
    factor->ldlt.compute(system);
    if (factor->ldlt.info() != Eigen::Success)
        throw NumericalError("deformation transfer: the system of this face has no solution");
    factor_ = std::move(factor);
}

std::vector<Vector> DeformationTransfer::motion(std::span<const Eigen::Matrix3d> gradients,
                                                std::span<const Vector> anchors_mm) const {
    const auto& parts = *mesh_.parts_;
    expect_size(gradients.size(), parts.triangles.size(), "gradients");
    expect_size(anchors_mm.size(), parts.anchors.size(), "motions of anchors");
    // Of the motion, not of the position: S less the identity, which the neutral face has.
    Columns right = Columns::Zero(static_cast<Eigen::Index>(parts.vertices), 3);
    for (std::size_t t = 0; t < parts.triangles.size(); ++t) {
        const Eigen::Matrix3d change = gradients[t] - Eigen::Matrix3d::Identity();
        for (std::size_t k = 0; k < 3; ++k)
            right.row(parts.row[parts.triangles[t][k]]) += (change * factor_->corners[t][k]).transpose();
    }
    for (std::size_t k = 0; k < anchors_mm.size(); ++k) {
        const auto v = parts.anchors[k];
        if (parts.used[v]) right.row(parts.row[v]) += parts.options.anchor_weight * anchors_mm[k].transpose();
    }
    const Columns solved = factor_->ldlt.solve(right);
    std::vector<Vector> motion;
    motion.reserve(parts.vertices);
    for (std::size_t v = 0; v < parts.vertices; ++v) motion.emplace_back(solved.row(parts.row[v]));
    return motion;
}

}  // namespace mimik::geometry
