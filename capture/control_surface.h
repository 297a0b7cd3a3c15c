#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "capture/marker_set.h"
#include "geometry/mesh.h"

namespace mimik::capture {

/// The triangles between the markers of a recording: what planar bones move a face by (Sanchez et al. 2003, Sec. 3).
struct ControlSurface {
    std::vector<std::string> corners;           ///< names, in the order asked for
    std::vector<geometry::Triangle> triangles;  ///< counter-clockwise seen from outside
    /// Per triangle, the parts of the face it may move (Sec. 4.3): bit part_bit(k, above) for what lies above or below
    /// opening k of the set. A triangle with a corner above an opening lacks the bit of what lies below, and the other
    /// way round.
    std::vector<std::uint32_t> parts;
    std::vector<std::string> left_out;  ///< corners of the set that are not there; their triangles are left out
};

/// The bit of what lies above or below an opening, counted as MarkerSet::openings counts them.
[[nodiscard]] constexpr std::uint32_t part_bit(std::size_t opening, bool above) {
    return std::uint32_t{1} << (2 * opening + (above ? 0 : 1));
}

/// The control surface of a set over those markers that there are. @param markers  names, in the order of the corners
/// @throws InputError if no triangle has all its corners.
[[nodiscard]] ControlSurface control_surface(const MarkerSet& set, std::span<const std::string> markers);

/// What is wrong with the triangles of a set where its markers are on some face whose +z leaves the face: flipped, flat
/// (less than a hundredth of their longest edge high), there twice, edges of more than two. One line each; empty:
/// nothing. Triangles with a corner that `places` lacks are passed over.
[[nodiscard]] std::vector<std::string> surface_faults(const MarkerSet& set, const geometry::Landmarks& places);

}  // namespace mimik::capture
