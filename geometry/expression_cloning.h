#pragma once

#include <span>
#include <vector>

#include "base/fields.h"
#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::geometry {

struct ExpressionCloningOptions {
    /// Neighbours of neighbours that belong to a vertex's surroundings, from which axes and box are taken. The paper
    /// has the triangles at the vertex alone, on meshes of some 1,000 vertices; at 2 mm from vertex to vertex those
    /// tell the noise of the fit, and chins crumple.
    int rings = 4;
    double most_scale = 2.0;  ///< a box that grows or shrinks by more along an axis counts as growing by so much
    /// Along an axis in which a box is thinner than this share of its length, its ratio is that of noise; the mean of
    /// the other axes' ratios is taken.
    double flat_share = 0.3;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("rings", self.rings);
        visit("most_scale", self.most_scale);
        visit("flat_share", self.flat_share);
    }
    void check() const;
};
static_assert(base::lists_every_field<ExpressionCloningOptions>());

/// Motion vectors of a source face for a target face of the same vertices and triangles: each is turned from the local
/// axes of its vertex (normal, an edge in the tangent plane, their product) to those on the target, and scaled along
/// each axis by how much larger the box about the vertex's surroundings is there. Noh and Neumann 2001, section 4. A
/// vertex without axes (no triangle, triangles that fold on themselves) keeps its motion as it is.
/// @throws InputError if the sizes differ, or of bad options.
[[nodiscard]] std::vector<Vector> cloned_motion(std::span<const Point> source_mm, std::span<const Vector> motion_mm,
                                                std::span<const Point> target_mm, std::span<const Triangle> triangles,
                                                const ExpressionCloningOptions& options = {});

}  // namespace mimik::geometry
