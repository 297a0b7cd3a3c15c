#pragma once

#include <span>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/types.h"
#include "geometry/vertex_mask.h"

namespace mimik::facs {

/// The border between upper and lower face: a quarter of the way from the eye corners' mean height down to the nose
/// tip.
/// @throws InputError if eye corners, nose tip or chin are missing.
class RegionBorder {
public:
    explicit RegionBorder(const geometry::Landmarks& landmarks);
    /// Positive in the upper face, negative in the lower.
    [[nodiscard]] double above_mm(const geometry::Point& position_mm) const { return up_.dot(position_mm) - border_; }

private:
    geometry::Vector up_;  // on this face, whatever its pose: across the eye line, away from the chin
    double border_;
};

/// How much of an AU's displacement each vertex takes: 1 in its half of the face, 0 in the other.
/// @param border_mm  the weight falls smoothly from 1 to 0 over this width about the border; 0: hard cut, as the
/// thesis.
[[nodiscard]] std::vector<double> region_weights(std::span<const geometry::Point> vertices_mm,
                                                 const geometry::VertexMask& present,
                                                 const geometry::Landmarks& landmarks, bool lower_face,
                                                 double border_mm);

}  // namespace mimik::facs
