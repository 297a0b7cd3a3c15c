#include <gtest/gtest.h>

#include "tests/support/analytic_face.h"

// [sample]
#include "preprocessing/gridding.h"

using namespace mimik;

/// A scan as 100 x 100 vertices, as a mesh without what was bridged over holes.
geometry::Mesh measured_surface(const geometry::RangeScan& scan) {
    preprocessing::GriddingOptions options;
    options.rows = options.cols = 100;
    preprocessing::GriddingReport report;
    const auto grid = preprocessing::grid_scan(scan, options, &report);
    if (report.measured == 0) return {};
    return geometry::to_mesh(grid, geometry::BridgedVertices::leave_out);
}
// [end]

TEST(Samples, a_hole_of_a_scan_is_a_hole_of_the_grid) {
    auto scan = test::AnalyticFace{}.scan(1.0);
    const auto whole = measured_surface(scan);
    for (auto& p : scan.points_mm)  // as if an eye had not been seen
        if (std::hypot(p.x() - 32, p.y() - 35) < 10) p.setConstant(std::numeric_limits<double>::quiet_NaN());
    const auto holed = measured_surface(scan);
    EXPECT_GT(whole.faces.size(), 5000U);
    EXPECT_LT(holed.faces.size() + 80, whole.faces.size());
}
