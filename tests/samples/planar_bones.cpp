#include <gtest/gtest.h>

#include "facs/reference_face.h"

// [sample]
#include "animation/marker_animator.h"

using namespace mimik;

/// How far every vertex of a face goes when its markers have gone to `markers_mm`.
/// @param labels  where the markers of the built-in set are on the face at rest, and the points that bear none
std::vector<geometry::Vector> by_planar_bones(const geometry::FaceSurface& face, const geometry::Landmarks& labels,
                                              std::span<const geometry::Point> markers_mm,
                                              std::span<const std::uint32_t> parts) {
    std::vector<std::string> tracked;
    for (const auto& marker : capture::builtin_marker_set().markers) tracked.push_back(marker.name);
    // `parts` are animation::vertex_parts() of the face; without them no mask parts the lips.
    const animation::MarkerAnimator animator(animation::MarkerMethod::bones, {face.vertices_mm, face.triangles, parts},
                                             capture::builtin_marker_set(), labels, tracked);
    std::vector<geometry::Vector> displacement_mm(animator.vertices());
    animator.displace(markers_mm, displacement_mm);
    return displacement_mm;
}
// [end]

namespace {

TEST(PlanarBonesSample, a_shift_of_the_markers_shifts_a_vertex_between_them) {
    const auto labels = capture::place_markers(capture::builtin_marker_set(), facs::reference_landmarks());
    geometry::FaceSurface face;
    for (const char* name : {"nose_tip", "nose_bridge", "nose_side_left"})
        face.vertices_mm.push_back(labels.position_mm(name));
    face.triangles = {{0, 1, 2}};
    std::vector<geometry::Point> markers;
    for (const auto& marker : capture::builtin_marker_set().markers)
        markers.emplace_back(labels.position_mm(marker.name) + geometry::Vector(1, 2, 3));
    for (const auto& d : by_planar_bones(face, labels, markers, {}))
        EXPECT_LT((d - geometry::Vector(1, 2, 3)).norm(), 1e-9);
}

}  // namespace
