#pragma once

#include <span>

#include "base/fields.h"
#include "geometry/surface_index.h"
#include "geometry/types.h"

namespace mimik::preprocessing {

struct RigidAlignmentOptions {
    int max_iterations = 60;
    double trim = 0.7;              ///< share of the points, closest first, that take part in each step
    double max_distance_mm = 15.0;  ///< pairs farther apart than this take no part at all
    /// A step smaller than both ends the iteration. Pairs change with every step, so smaller ones are noise: on scans
    /// whose true pose is known, stopping at a twentieth of this or using all points comes no closer to it.
    double stop_rotation_deg = 2e-3;
    double stop_shift_mm = 2e-3;
    std::size_t max_points = 2000;  ///< of the source, evenly through the list
    /// The first steps, until they are small, are made with so many points; 0: with all of max_points.
    std::size_t coarse_points = 400;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("trim", self.trim);
        visit("max_distance_mm", self.max_distance_mm);
        visit("max_iterations", self.max_iterations);
        visit("max_points", self.max_points);
        visit("coarse_points", self.coarse_points);
        visit("stop_rotation_deg", self.stop_rotation_deg);
        visit("stop_shift_mm", self.stop_shift_mm);
    }
    void check() const;
};
static_assert(base::lists_every_field<RigidAlignmentOptions>());

struct RigidAlignment {
    geometry::Transform target_from_source = geometry::Transform::Identity();
    double rms_mm = 0.0;  ///< point to plane, weighted, over the pairs of the last step
    std::size_t pairs_used = 0;
    std::size_t border_hits = 0;  ///< closest point on the target's border: left out
    int iterations = 0;
    bool converged = false;
};

/// Trimmed point-to-plane ICP: rotation and translation that bring `source` points onto the target surface.
/// (Chen and Medioni 1992 for the distance; Chetverikov et al. 2002 for the trimming.) The normals are those of the
/// target's triangles. Give only points of a region that does not move with the expression.
/// @param weights  one per source point, how much its squared distance counts; empty: all the same.
/// @throws InputError for bad options or weights; NumericalError if fewer than 30 pairs remain.
[[nodiscard]] RigidAlignment align_rigidly(std::span<const geometry::Point> source_mm,
                                           const geometry::SurfaceIndex& target,
                                           const geometry::Transform& start = geometry::Transform::Identity(),
                                           const RigidAlignmentOptions& options = {},
                                           std::span<const double> weights = {});

}  // namespace mimik::preprocessing
