#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/fields.h"
#include "geometry/mesh.h"
#include "geometry/surface_index.h"
#include "geometry/types.h"
#include "geometry/vertex_mask.h"

namespace mimik::preprocessing {

/// A surface that templates are fitted to: closest points and smooth normals.
class FitTarget {
public:
    /// @throws as geometry::SurfaceIndex.
    FitTarget(std::span<const geometry::Point> vertices_mm, std::span<const geometry::Triangle> triangles);
    [[nodiscard]] const geometry::SurfaceIndex& surface() const { return surface_; }
    [[nodiscard]] geometry::Vector normal(const geometry::SurfacePoint& at) const;

private:
    geometry::SurfaceIndex surface_;
    std::vector<geometry::Vector> normals_;
};

/// Where a mark of the template has to go.
struct FitMark {
    geometry::Triangle corners = {0, 0, 0};
    Eigen::Vector3d weights = Eigen::Vector3d::UnitX();
    geometry::Point target_mm = geometry::Point::Zero();
    double weight = 1.0;  ///< in NonrigidFitOptions::mark_weight
};

struct NonrigidFitOptions {
    double first_smoothness = 15.0;  ///< weight of the first stage
    double last_smoothness = 0.1;    ///< of the last; those between by equal ratios
    int stages = 4;
    int steps = 2;                ///< of each stage: pairs, then a solution
    double point_share = 0.2;     ///< of the distance to the closest point itself, beside that to its plane
    double mark_weight = 1.5;     ///< of a landmark, in vertices of 9 mm^2
    double least_cosine = 0.5;    ///< between normals of a pair
    double most_mm = 12.0;        ///< pairs farther apart take no part
    double least_scale_mm = 3.0;  ///< of the robust weights, which follow the residuals down to it
    double bend_mm = 0.0;    ///< correction of neighbours may differ by this before it costs less: 0 = no such limit
    double stillness = 0.0;  ///< weight that holds every vertex at `rest_mm`
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("first_smoothness", self.first_smoothness);
        visit("last_smoothness", self.last_smoothness);
        visit("stages", self.stages);
        visit("steps", self.steps);
        visit("point_share", self.point_share);
        visit("mark_weight", self.mark_weight);
        visit("least_cosine", self.least_cosine);
        visit("most_mm", self.most_mm);
        visit("least_scale_mm", self.least_scale_mm);
        visit("bend_mm", self.bend_mm);
        visit("stillness", self.stillness);
    }
    void check() const;
    [[nodiscard]] double smoothness(int stage) const;
};
static_assert(base::lists_every_field<NonrigidFitOptions>());

struct NonrigidFit {
    std::vector<geometry::Point> vertices_mm;
    std::vector<double> residual_mm;  ///< per vertex: distance to the surface, whether the pair is sound or not
    geometry::VertexMask matched;     ///< per vertex: its last pair was sound
    double matched_share = 0.0;
    double residual_rms_mm = 0.0;  ///< of the matched vertices
};

/// What is known of single vertices beforehand.
struct FitHints {
    std::span<const geometry::Point> rest_mm = {};  ///< where stillness holds them; empty: nowhere
    std::span<const double> stillness = {};         ///< times that of the options; empty: 1
    std::span<const std::uint8_t> on_rim = {};      ///< may lie on a border of the surface: rims of lips; empty: none
};

/// Bends a mesh on to a surface: point-to-plane closest-point fits whose correction to the start is smooth, less and
/// less so. What depends on the mesh alone is made once; from any thread.
class NonrigidFitter {
public:
    /// @param vertices_mm  at rest: their areas weigh the data
    NonrigidFitter(std::span<const geometry::Point> vertices_mm, std::span<const geometry::Triangle> triangles);
    ~NonrigidFitter();
    NonrigidFitter(NonrigidFitter&&) noexcept;
    /// @param start_mm  where the vertices begin
    /// @throws InputError for bad options or sizes; NumericalError if the fit has no solution.
    [[nodiscard]] NonrigidFit fit(std::span<const geometry::Point> start_mm, const FitTarget& target,
                                  std::span<const FitMark> marks, const NonrigidFitOptions& options = {},
                                  const FitHints& hints = {}) const;

    struct Impl;

private:
    std::unique_ptr<const Impl> impl_;
};

}  // namespace mimik::preprocessing
