#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/face_surface.h"
#include "geometry/landmarks.h"
#include "geometry/quad_grid.h"
#include "geometry/surface_index.h"
#include "geometry/vertex_mask.h"

namespace mimik::evaluation {

/// One target and its real expressive scan: what all methods are judged by.
struct ScoredTarget {
    std::vector<std::uint32_t> vertices;  ///< scored: measured, and doing nothing does not hit the scan's border
    std::vector<std::uint8_t> in_zone;    ///< parallel to `vertices`
    std::vector<double> nothing_mm;       ///< parallel to `vertices`: distance of doing nothing
    /// Parallel to `vertices`, scanner frame; empty without a truth.
    std::vector<geometry::Vector> true_displacement_mm;
    std::optional<geometry::SurfaceIndex> expressive;  ///< the real expressive scan, in the neutral's scanner frame
    /// Per vertex of the expressive scan's grid: it stands at the border of a hole; empty: unknown.
    geometry::VertexMask hole_rim = {};
    geometry::Landmarks expressive_landmarks = {};  ///< of the real expressive scan, in the neutral's scanner frame
    geometry::VertexMask still = {};  ///< parallel to `vertices`: skin that should hold still; empty: unknown
    bool whole_face = true;           ///< score the face outside the zone, too

    [[nodiscard]] std::size_t zone_size() const;
};

/// The measured vertices of `neutral` that see the real expressive scan, and what doing nothing scores there. What is
/// truly known of the target, its landmarks and the skin that holds still are for the caller to add.
/// @param zone  per vertex of `neutral`: 1 in the active zone, as carry_zone
/// @throws InputError if the expressive scan has no surface.
[[nodiscard]] ScoredTarget scored_target(const geometry::FaceSurface& neutral, const geometry::QuadGrid& expressive,
                                         const geometry::Transform& neutral_from_expressive,
                                         const geometry::VertexMask& zone);

}  // namespace mimik::evaluation
