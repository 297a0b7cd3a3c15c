#include "geometry/topology.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/disjoint_sets.h"
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

TEST(DisjointSets, the_lowest_item_stands_for_a_set_in_whatever_order_it_was_joined) {
    DisjointSets sets(6);
    sets.join(5, 4);
    sets.join(4, 2);
    sets.join(3, 1);
    for (const std::uint32_t item : {2U, 4U, 5U}) EXPECT_EQ(sets.root(item), 2U);
    EXPECT_EQ(sets.root(3), 1U);
    EXPECT_EQ(sets.root(0), 0U);
    sets.join(5, 3);
    for (std::uint32_t item = 1; item < 6; ++item) EXPECT_EQ(sets.root(item), 1U);
}

TEST(BorderEdges, are_those_of_one_face_in_ascending_order) {
    Faces faces;
    faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    faces.add(std::vector<std::uint32_t>{1, 4, 2});
    const std::vector<Edge> expected = {{0, 1}, {0, 3}, {1, 4}, {2, 3}, {2, 4}};
    EXPECT_EQ(border_edges(faces), expected);
    EXPECT_EQ(border_edges(triangulate(faces)), expected);  // a diagonal has two triangles
    EXPECT_TRUE(border_edges(Faces{}).empty());
}

}  // namespace
}  // namespace mimik::geometry
