#include <gtest/gtest.h>

#include "tests/support/analytic_face.h"

// [sample]
#include "geometry/landmark_spline.h"

using namespace mimik;

/// Where points of one face lie on another, by the landmarks that both have.
std::vector<geometry::Point> carried(const geometry::Landmarks& from, const geometry::Landmarks& to,
                                     const std::vector<geometry::Point>& points_mm) {
    const geometry::LandmarkPairs pairs(from, to);
    pairs.require_partners();  // names what only one of the two has
    geometry::ThinPlateSplineOptions options;
    options.smoothing = 10;  // mm: marks are off by 0.5 to 1 mm, and need not be hit
    return pairs.fit(options).apply(points_mm);
}
// [end]

TEST(Samples, a_spline_carries_points_of_a_face_to_one_of_another_size) {
    const test::AnalyticFace small{1.0}, large{1.1};
    const auto there = carried(small.landmarks(), large.landmarks(), {small.point(10, 20), small.point(-30, -10)});
    EXPECT_LT((there[0] - large.point(10, 20)).norm(), 1e-9);  // a similarity bends nothing: smoothing leaves it alone
    EXPECT_LT((there[1] - large.point(-30, -10)).norm(), 1e-9);
}
