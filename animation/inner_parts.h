#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::animation {

/// What lies behind the skin of a mesh as parts of their own: eyeballs and upper teeth stay where they are, lower teeth
/// and tongue turn with the jaw.
struct InnerParts {
    /// Per vertex, 0 to 1: how much it is no skin, and so does not take the motion of the skin that is nearest.
    std::vector<double> inside;
    /// Per vertex, 0 to 1: how much it turns with the jaw; where `inside` is 0: 0.
    std::vector<double> on_jaw;
    std::size_t eye_vertices = 0, mouth_vertices = 0;

    [[nodiscard]] bool empty() const { return eye_vertices + mouth_vertices == 0; }
};

/// Finds them by the parts that hang together: one that lies behind the skin for the most part, near an eye or within
/// the mouth. The part that has the nose tip is skin whatever its shape, so the walls of a mouth that belong to it are.
/// Empty where a landmark of the eyes, the mouth or the nose is missing.
/// @param vertices_mm  average frame
/// @param behind_mm    per vertex: how far behind the skin it lies; negative: before it
[[nodiscard]] InnerParts find_inner_parts(std::span<const geometry::Point> vertices_mm,
                                          std::span<const geometry::Triangle> triangles,
                                          const geometry::Landmarks& landmarks, std::span<const double> behind_mm);

/// The turn of a jaw about an axis through its joints, from how the skin of the chin moves; one that opens, or none
/// (nor without a chin).
/// @param landmarks  of the neutral face, average frame
[[nodiscard]] geometry::Transform jaw_turn(const geometry::Landmarks& landmarks,
                                           const geometry::Vector& chin_motion_mm);

}  // namespace mimik::animation
