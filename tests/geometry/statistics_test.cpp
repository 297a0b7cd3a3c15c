#include "geometry/statistics.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "geometry/disjoint_sets.h"
#include "geometry/thin_plate_spline.h"
#include "geometry/topology.h"

namespace mimik::geometry {
namespace {

TEST(UpperMedian, is_the_middle_one_and_of_an_even_number_the_upper_of_the_two) {
    EXPECT_EQ(upper_median({3, 1, 2}), 2);
    EXPECT_EQ(upper_median({4, 1, 3, 2}), 3);
    EXPECT_EQ(upper_median({7}), 7);
    EXPECT_EQ(upper_median({}), 0);
}

TEST(Median, is_the_mean_of_the_two_in_the_middle_of_an_even_number) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
    EXPECT_THROW((void)median({}), InputError);
}

TEST(Quantile, is_linear_between_the_values_in_order) {
    const std::vector<double> values = {40, 10, 30, 20};
    EXPECT_EQ(quantile(values, 0), 10);
    EXPECT_EQ(quantile(values, 1), 40);
    EXPECT_EQ(quantile(values, 0.5), 25);
    EXPECT_EQ(quantile(values, 0.25), 17.5);
    EXPECT_EQ(quantile({7}, 0.3), 7);
}

TEST(Quantile, of_nothing_of_nan_or_beyond_all_is_refused) {
    EXPECT_THROW((void)quantile({}, 0.5), InputError);
    EXPECT_THROW((void)quantile({1, std::numeric_limits<double>::quiet_NaN()}, 0.5), InputError);
    EXPECT_THROW((void)quantile({1, 2}, 1.5), InputError);
    EXPECT_THROW((void)quantile({1, 2}, std::numeric_limits<double>::quiet_NaN()), InputError);
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
