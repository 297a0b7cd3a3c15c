#include <map>

#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"

// [sample]
#include "modeling/control_points.h"

using namespace mimik;

/// How many points of each kind an expression has on a face in an upright frame.
std::map<facs::ControlKind, int> points_of(const std::string& code, const geometry::Landmarks& landmarks,
                                           const geometry::SurfaceIndex& surface) {
    const auto& catalogue = facs::builtin_catalogue();
    const auto placed = modeling::place_controls(catalogue, catalogue.expression(code), landmarks, surface);
    std::map<facs::ControlKind, int> count;
    for (const auto* points : {&placed.controls, &placed.anchors})
        for (const auto& point : *points) ++count[point.kind];
    return count;
}
// [end]

TEST(Samples, a_smile_has_points_of_every_kind) {
    const auto average = test::analytic_average();
    const geometry::SurfaceIndex surface(average.grid.vertices_mm, geometry::triangles(average.grid));
    auto count = points_of("AU12", average.landmarks, surface);
    EXPECT_GE(count[facs::ControlKind::muscle], 6);  // mouth corner and zygomaticus, left and right
    EXPECT_GE(count[facs::ControlKind::carried], 4);
    EXPECT_GE(count[facs::ControlKind::wrinkle], 4);
    EXPECT_GE(count[facs::ControlKind::coverage], 30);
    EXPECT_GE(count[facs::ControlKind::anchor], 10);
    auto left = points_of("12L", average.landmarks, surface);
    EXPECT_LT(left[facs::ControlKind::muscle], count[facs::ControlKind::muscle]);
}
