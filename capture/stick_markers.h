#pragma once

#include <string>
#include <vector>

#include "capture/marker_set.h"
#include "geometry/surface_index.h"

namespace mimik::capture {

/// Markers on the skin of a face.
struct StuckMarkers {
    std::vector<std::string> names;              ///< those of the set, then the derived ones
    std::vector<geometry::SurfacePoint> places;  ///< in that order

    [[nodiscard]] geometry::Landmarks landmarks() const;
};

/// Sticks the markers of a set to a face. place_markers() says where they are near the surface; most go to its nearest
/// point. Two kinds go straight along z instead, to what is seen from the front:
///  - markers of the midline between landmarks, which lie within a nose, say: the nearest point would be on one of its
///    sides;
///  - markers of lids, which lie within an eye: the nearest point would be on the eyeball, or in its socket, where
///    nothing moves. Where the eyeball is a part of its own, they go to the nearest skin that is seen, the lid's
///    margin.
/// Landmarks themselves are on the skin already.
/// @param face  landmarks of the face, in a frame whose x is the subject's left, y up and z out of the face
/// @throws InputError naming a landmark that is missing.
[[nodiscard]] StuckMarkers stick_markers(const MarkerSet& set, const geometry::Landmarks& face,
                                         const geometry::SurfaceIndex& skin);

}  // namespace mimik::capture
