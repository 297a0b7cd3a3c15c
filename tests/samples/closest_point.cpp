#include <gtest/gtest.h>

// [sample]
#include "geometry/surface_index.h"

using namespace mimik;

/// How far a point is from a surface; negative without an answer: the nearest point lies on the border.
double distance_inside_mm(const geometry::SurfaceIndex& surface, const geometry::Point& query_mm) {
    const auto nearest = surface.closest(query_mm);
    return surface.on_border(nearest) ? -1.0 : nearest.distance_mm;
}
// [end]

TEST(Samples, the_closest_point_of_a_square_is_straight_below_or_on_its_border) {
    const std::vector<geometry::Point> corners = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
    const std::vector<geometry::Triangle> halves = {{0, 1, 2}, {0, 2, 3}};
    const geometry::SurfaceIndex surface(corners, halves);
    EXPECT_EQ(distance_inside_mm(surface, {7, 3, 5}), 5);
    EXPECT_EQ(distance_inside_mm(surface, {12, 3, 5}), -1);
}
