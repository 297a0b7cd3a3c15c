#include "evaluation/data_zone.h"

#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"

namespace mimik::evaluation {
namespace {

using geometry::Point;
using geometry::Vector;

TEST(MotionOnAverage, is_that_of_the_nearest_point_of_the_template_and_none_off_the_face) {
    const auto average = test::analytic_average();
    const auto face_template = preprocessing::build_face_template(average);
    // The vertex of the lattice that is moved on to the line between the lips goes along: a field of positions.
    std::vector<Vector> positions_mm(face_template.surface.vertices_mm.begin(),
                                     face_template.surface.vertices_mm.end());
    const auto carried = MotionOnAverage(average, face_template).of(positions_mm);
    ASSERT_EQ(carried.size(), average.grid.size());
    std::size_t on_face = 0, near = 0;
    for (std::size_t v = 0; v < carried.size(); ++v) {
        if (!average.grid.inside(v)) {
            EXPECT_EQ(carried[v], Vector(Vector::Zero()));
            continue;
        }
        ++on_face;
        near += (carried[v] - average.grid.vertices_mm[v]).norm() < 0.5 ? 1 : 0;
    }
    // Chords of 2 mm leave 0.1 mm of a nose of 9 mm width; at the rim the template ends up to 2 mm earlier.
    EXPECT_GT(static_cast<double>(near), 0.95 * static_cast<double>(on_face));
}

}  // namespace
}  // namespace mimik::evaluation
