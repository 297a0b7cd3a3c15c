#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/fields.h"
#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::geometry {

/// How each triangle of a mesh is turned and stretched by a motion: S of x -> S x + d, whose third column pair is the
/// fourth vertex that stands on the triangle, v1 + (v2 - v1) x (v3 - v1) / sqrt|(v2 - v1) x (v3 - v1)|.
/// Sumner and Popovic 2004, Eqs 1 to 4. @throws NumericalError naming a triangle without area.
[[nodiscard]] std::vector<Eigen::Matrix3d> deformation_gradients(std::span<const Point> rest_mm,
                                                                 std::span<const Vector> motion_mm,
                                                                 std::span<const Triangle> triangles);

struct DeformationTransferOptions {
    /// Of an anchor's squared miss (mm^2) beside a triangle's squared error of S (no unit). At 2 mm from vertex to
    /// vertex a triangle's weight is about 0.5, so anchors keep to a small part of their triangles' errors.
    double anchor_weight = 1.0;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("anchor_weight", self.anchor_weight);
    }
    void check() const;
};
static_assert(base::lists_every_field<DeformationTransferOptions>());

/// What all faces of one mesh share: its triangles, its anchors and the order in which unknowns are eliminated.
class DeformationTransferMesh {
public:
    /// @param anchors  vertices whose motion is given; one or more in each piece that hangs together, since gradients
    /// alone do not say where a piece is. A vertex of no triangle does not move.
    /// @throws InputError of bad options, no triangle, a vertex that is not there, or a piece without an anchor.
    DeformationTransferMesh(std::size_t vertices, std::vector<Triangle> triangles, std::vector<std::uint32_t> anchors,
                            const DeformationTransferOptions& options = {});

    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] std::span<const Triangle> triangles() const;
    [[nodiscard]] std::span<const std::uint32_t> anchors() const;

private:
    friend class DeformationTransfer;
    struct Parts;
    std::shared_ptr<const Parts> parts_;
};

/// Puts the deformation of one face on another of the same triangles: vertices whose gradients are nearest to the given
/// ones in least squares, every triangle alike (Sumner and Popovic 2004, Eq. 6). The fourth vertex of a triangle stands
/// in no other triangle, so it is eliminated by hand; what is left has one unknown per vertex and axis. Factorised once
/// per target. From any thread.
class DeformationTransfer {
public:
    /// @param rest_mm  the target's neutral face
    /// @throws InputError if the sizes differ; NumericalError naming a triangle without area, or of a face whose
    /// system has no solution.
    DeformationTransfer(DeformationTransferMesh mesh, std::span<const Point> rest_mm);

    /// @param gradients   of the source, one per triangle
    /// @param anchors_mm  where each anchor goes, from where it is
    /// @return how each vertex moves
    [[nodiscard]] std::vector<Vector> motion(std::span<const Eigen::Matrix3d> gradients,
                                             std::span<const Vector> anchors_mm) const;

private:
    struct Factor;
    DeformationTransferMesh mesh_;
    std::shared_ptr<const Factor> factor_;
};

}  // namespace mimik::geometry
