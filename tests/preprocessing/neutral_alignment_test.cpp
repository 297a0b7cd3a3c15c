#include "preprocessing/neutral_alignment.h"

#include <gtest/gtest.h>

#include "preprocessing/stable_region.h"
#include "tests/support/analytic_workspace.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;

TEST(AlignToNeutral, a_jaw_that_rests_elsewhere_turns_the_forehead_less_than_if_it_counted_in_full) {
    // The whole face is said to hold still, but the jaw of the second scan is a little open: below y = -10 the skin
    // goes back, 1 mm at the chin. Were all points alike, that would turn the head.
    const test::AnalyticFace shape;
    auto open = shape.scan(1.0);
    for (auto& p : open.points_mm)
        if (p.allFinite()) p.z() += 0.02 * std::min(0.0, p.y() + 10);
    Face neutral, scan;
    neutral.grid = grid_scan(shape.scan(1.0));
    scan.grid = grid_scan(open);
    neutral.landmarks = scan.landmarks = shape.landmarks();
    const RigidAlignmentOptions all{.trim = 1.0};  // closed forms have no noise, so trimming would find the jaw
    align_to_neutral(scan, neutral, geometry::VertexMask(neutral.grid.size(), 1), all);

    std::vector<Point> everything;
    for (std::size_t v = 0; v < neutral.grid.size(); ++v)
        if (neutral.grid.measured(v)) everything.push_back(neutral.grid.vertices_mm[v]);
    const geometry::SurfaceIndex surface(scan.grid.vertices_mm,
                                         geometry::triangles(scan.grid, geometry::BridgedVertices::leave_out));
    const auto plain = align_rigidly(everything, surface, geometry::Transform::Identity(), all);
    const Point forehead = shape.point(0, 75);
    const double error_mm = (scan.neutral_from_scan * forehead - forehead).norm();
    const double plain_mm = (plain.target_from_source * forehead - forehead).norm();
    EXPECT_GT(plain_mm, 0.1);  // else this test could not fail
    // The jaw is far from the middle, so a fifth of its weight still has half its leverage; all alike would give 1.
    EXPECT_LT(error_mm, 0.8 * plain_mm);
}

TEST(AlignToNeutral, fear_that_moves_brows_temples_and_jaw_does_not_turn_the_head) {
    // Above the eyes (y = 35) the skin comes forward, by 2 mm at the hairline; below the nose tip (y = 0) it goes back,
    // by 2 mm at the chin. Nose and cheeks hold still.
    const test::AnalyticFace shape;
    auto afraid = shape.scan(1.0);
    for (auto& p : afraid.points_mm)
        if (p.allFinite()) p.z() += 0.05 * std::max(0.0, p.y() - 36) + 0.03 * std::min(0.0, p.y() + 16);
    Face neutral, scan;
    neutral.grid = grid_scan(shape.scan(1.0));
    scan.grid = grid_scan(afraid);
    neutral.landmarks = scan.landmarks = shape.landmarks();
    const auto error_mm = [&](const geometry::VertexMask& stable) {
        align_to_neutral(scan, neutral, stable);
        double worst = 0;
        for (const Point& p : {shape.point(0, 75), shape.point(0, -60), shape.point(60, 20)})
            worst = std::max(worst, (scan.neutral_from_scan * p - p).norm());
        return worst;
    };
    const auto fear = *facs::parse_expression("FEAR");
    EXPECT_GT(error_mm(stable_on_every_face(neutral)), 0.1);  // its temples move: else this test could not fail
    EXPECT_LT(error_mm(stable_vertices(facs::builtin_catalogue(), fear, neutral)), 0.03);
}

}  // namespace
}  // namespace mimik::preprocessing
