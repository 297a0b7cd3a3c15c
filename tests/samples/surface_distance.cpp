#include <gtest/gtest.h>

#include "tests/support/analytic_face.h"

// [sample]
#include <algorithm>

#include "evaluation/surface_distance.h"

using namespace mimik;

/// The distance below which 95 % of the vertices of both meshes lie from the other mesh.
double distance_of_most_mm(const geometry::Mesh& test, const geometry::Mesh& reference) {
    const auto distance = evaluation::surface_distance(test, reference);
    const double there = distance.test_to_reference.summary.p95_mm;
    const double back = distance.reference_to_test ? distance.reference_to_test->summary.p95_mm : 0.0;
    return std::max(there, back);
}
// [end]

TEST(Samples, a_plane_two_millimetres_above_another_is_two_millimetres_off) {
    geometry::Mesh plane;
    plane.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
    plane.faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    auto above = plane;
    for (auto& vertex : above.vertices_mm) vertex.z() += 2;
    EXPECT_EQ(distance_of_most_mm(above, plane), 2);
}
