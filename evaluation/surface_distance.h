#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/surface_index.h"
#include "geometry/types.h"
#include "geometry/vertex_mask.h"

namespace mimik::evaluation {

/// Unsigned distances of n vertices, each counted once, mm.
struct DistanceSummary {
    std::size_t n = 0;
    double mean_mm = 0.0;
    double rms_mm = 0.0;
    double median_mm = 0.0;
    double p95_mm = 0.0;  ///< 95th percentile, as geometry::quantile()
    double max_mm = 0.0;
    std::size_t border_hits = 0;  ///< of n: closest point on the reference's border (kept in the figures above)
};

/// One side: from vertices to the nearest point of a surface.
struct VertexDistances {
    std::vector<double> distance_mm;  ///< one per vertex; NaN where the mask leaves it out
    geometry::VertexMask on_border;   ///< one per vertex; 1: the nearest point lies on the reference's border
    DistanceSummary summary;
};

/// Sums run in the order of the vertices, so the figures are the same on any number of threads.
/// @param counts  empty: every vertex counts; else one per vertex, 0 leaves it out (its position may then be NaN).
/// @throws InputError if the mask has another size, leaves nothing, or a vertex that counts is not finite.
[[nodiscard]] VertexDistances distances_to_surface(std::span<const geometry::Point> vertices_mm,
                                                   const geometry::SurfaceIndex& reference,
                                                   std::span<const std::uint8_t> counts = {});

/// The summary of distances that are already there, of the vertices that count.
[[nodiscard]] DistanceSummary summarize(std::span<const double> distance_mm,
                                        std::span<const std::uint8_t> on_border = {},
                                        std::span<const std::uint8_t> counts = {});

struct SurfaceDistance {
    VertexDistances test_to_reference;
    std::optional<VertexDistances> reference_to_test;  ///< none if `test` has no face
};

/// Both sides: every vertex of each to the surface of the other. `test` may be a bare cloud.
/// @throws InputError if `reference` has no face (a cloud has no surface to measure to) or a vertex is not finite.
[[nodiscard]] SurfaceDistance surface_distance(const geometry::Mesh& test, const geometry::Mesh& reference);

}  // namespace mimik::evaluation
