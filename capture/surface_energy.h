#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/fields.h"
#include "geometry/mesh.h"
#include "geometry/surface_index.h"

namespace mimik::capture {

/// Weights of the three energies (alpha, beta and gamma of Eq. 17 of Sanchez et al. 2003).
struct SurfaceEnergyOptions {
    double distance = 1.0;  ///< of the mean distance to the target, per mm
    double strain = 0.5;    ///< of the mean change of an edge's length, per mm
    double bending = 2.0;   ///< of the mean change of the product of the normals beside an edge, which has no unit
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("distance", self.distance);
        visit("strain", self.strain);
        visit("bending", self.bending);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<SurfaceEnergyOptions>());

/// The energy of a pose, and the three that it is made of, without their weights.
struct SurfaceEnergyParts {
    double distance_mm = 0, strain_mm = 0, bending = 0;
    double total = 0;  ///< with them
};

/// How far a small surface lies from a target, and how much it is stretched and bent (Eqs 17 and 18 of Sanchez et al.
/// 2003):
///     E = alpha mean_v d(v) + beta mean_e |len(e) - len_0(e)| + gamma mean_e |n1 n2 - (n1 n2)_0|
/// over vertices v and edges e; n1 and n2 are the normals beside an edge that has two triangles. It is a sum of weights
/// times sizes of terms of at most four vertices each, which is what minimisers are handed.
class SurfaceEnergy {
public:
    static constexpr std::size_t most_corners = 4;
    struct Term {
        enum class Kind { distance, strain, bending } kind = Kind::distance;
        std::uint32_t count = 1;  ///< of its corners: 1, 2 or 4
        std::array<std::uint32_t, most_corners> corners = {};
        double weight = 0;  ///< with the mean's divisor
        double at_rest = 0;
    };

    /// @param rest_mm  the pose whose lengths and angles are kept
    /// @param target  outlives this
    /// @throws InputError for bad options, a triangle of an unknown vertex, or without a triangle.
    SurfaceEnergy(std::span<const geometry::Point> rest_mm, std::span<const geometry::Triangle> triangles,
                  const geometry::SurfaceIndex& target, const SurfaceEnergyOptions& options = {});

    [[nodiscard]] std::size_t vertices() const { return vertices_; }
    [[nodiscard]] std::span<const Term> terms() const { return terms_; }
    [[nodiscard]] SurfaceEnergyParts of(std::span<const geometry::Point> pose_mm) const;
    /// What a term weighs the size of, with its sign: a distance is below 0 on the inner side.
    /// @param corners_mm  of the term alone  @param gradients  as many, or null
    [[nodiscard]] double residual(const Term& term, const geometry::Point* corners_mm,
                                  geometry::Vector* gradients = nullptr) const;

private:
    [[nodiscard]] double distance(const geometry::Point& at_mm, geometry::Vector* gradient) const;

    std::size_t vertices_ = 0;
    SurfaceEnergyOptions options_;
    std::vector<Term> terms_;
    const geometry::SurfaceIndex* target_;
};

}  // namespace mimik::capture
