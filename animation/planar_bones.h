#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/fields.h"
#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::animation {

struct PlanarBonesOptions {
    /// R_j of a bone: this share of the shortest edge that touches one of its corners (Sec. 4.2). The paper says "a
    /// fraction"; with 1 the bones on both sides of an edge act on each other's surface, and what lies further than an
    /// edge's length stays.
    double radius_share = 1.0;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("radius_share", self.radius_share);
    }
    /// @throws InputError if the share is not positive and finite.
    void check() const;
};
static_assert(base::lists_every_field<PlanarBonesOptions>());

/// Which bones may move which vertices (Sec. 4.3): a bone acts where the two have a bit in common. Empty: all act on
/// all. So that a lower lip is not dragged along by the upper one.
struct BoneMasks {
    std::vector<std::uint32_t> of_bone, of_vertex;
};

/// A coarse control surface that moves a fine mesh (planar bones: Sanchez et al. 2003, Eqs 1-12). Every triangle of the
/// control surface carries the vertices near it: over the triangle by its affine map (Eq. 1), beside an edge by a frame
/// that scales along the edge only (Eq. 9), round a corner by a frame that keeps distances from it (Eq. 10).
///
/// Eq. 11 as printed adds positions up, which only makes sense with weights that sum to one. Here a vertex moves by
///     fade * sum_j w_j (s_j - S) / sum_j w_j,    w_j by Eq. 12,
/// with fade 1 within half a radius of some bone (largest w_j >= 1/2) and sin^2(pi * largest w_j) beyond, so that the
/// motion ends smoothly at the radius. The regions are those of the nearest feature of a triangle; in Eq. 3 as printed
/// the candidates bear other numbers than the edges of Eq. 6.
class PlanarBones {
public:
    PlanarBones() = default;
    /// @param control_mm  corners of the control surface at rest  @param triangles  of it, counter-clockwise seen from
    /// outside  @param vertices_mm  of the mesh at rest, in the same frame
    /// @throws InputError if a number is not finite, a triangle has a corner that there is not or no area, or the masks
    /// are not as many as bones and vertices.
    PlanarBones(std::span<const geometry::Point> control_mm, std::span<const geometry::Triangle> triangles,
                std::span<const geometry::Point> vertices_mm, const PlanarBonesOptions& options = {},
                const BoneMasks& masks = {});

    /// Where the vertices go when the corners are at `control_mm`: one displacement a vertex, zero where no bone
    /// reaches. The same values on any number of threads. @throws InputError if the counts differ.
    void displace(std::span<const geometry::Point> control_mm, std::span<geometry::Vector> displacement_mm) const;

    [[nodiscard]] std::span<const double> radii_mm() const { return radii_mm_; }  ///< of every bone
    [[nodiscard]] std::size_t vertices() const { return first_.size() - 1; }
    [[nodiscard]] std::size_t influences() const { return influences_.size(); }  ///< pairs of bone and vertex
    /// Bones that act on a vertex.
    [[nodiscard]] std::size_t influences_on(std::size_t vertex) const { return first_[vertex + 1] - first_[vertex]; }

    /// Where a vertex lies as seen from a triangle: over it, beside an edge, round a corner.
    enum class Region : std::uint8_t { face, edge_0, edge_1, edge_2, corner_0, corner_1, corner_2 };

private:
    struct Influence {
        std::uint32_t bone = 0;
        Region region = Region::face;
        double weight = 0;          ///< with the fade, and divided by the sum
        geometry::Vector local;     ///< the vertex in the region's frame
        double from_corner_mm = 0;  ///< D of Eq. 10, of a corner's region
    };
    struct Bone {
        std::array<geometry::Point, 3> corners;
        std::array<Eigen::Matrix3d, 7> frames;  ///< columns: the rows of the paper's matrices
    };
    [[nodiscard]] static Bone bone(std::span<const geometry::Point> control_mm, const geometry::Triangle& triangle);
    void find_radii(std::span<const geometry::Point> control_mm, double share);
    void bind(const std::vector<Bone>& bones, const geometry::Point& vertex_mm, std::uint32_t mask,
              const BoneMasks& masks);

    std::vector<geometry::Triangle> triangles_;
    std::size_t controls_ = 0;
    std::vector<geometry::Point> vertices_mm_;
    std::vector<double> radii_mm_;
    std::vector<std::size_t> first_ = {0};  ///< of every vertex in `influences_`, and one more
    std::vector<Influence> influences_;
};

}  // namespace mimik::animation
