#include "geometry/topology.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/weld.h"

namespace mimik::geometry {
namespace {

TEST(ConnectedParts, triangles_that_share_a_vertex_or_a_place_are_one_part) {
    // 0-1-2 and 3-4-5 meet at one place (2 and 3), as where a texture cuts; 6-7-8 is alone; no triangle uses 9.
    const std::vector<Point> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 2, 0},
                                         {0, 2, 0}, {9, 0, 0}, {9, 1, 0}, {9, 0, 1}, {5, 5, 5}};
    const std::vector<Triangle> triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};

    const auto part = connected_parts(vertices, triangles);

    ASSERT_EQ(part.size(), vertices.size());
    for (const std::size_t vertex : {1, 2, 3, 4, 5}) EXPECT_EQ(part[vertex], part[0]) << "vertex " << vertex;
    EXPECT_EQ(part[7], part[6]);
    EXPECT_EQ(part[8], part[6]);
    EXPECT_NE(part[6], part[0]);
    EXPECT_EQ(part[9], not_welded);
}

TEST(ConnectedParts, of_no_triangles_there_are_none) {
    const std::vector<Point> vertices = {{0, 0, 0}, {1, 0, 0}};
    for (const auto part : connected_parts(vertices, {})) EXPECT_EQ(part, not_welded);
}

}  // namespace
}  // namespace mimik::geometry
