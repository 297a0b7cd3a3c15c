#include "geometry/point_index.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"

namespace mimik::geometry {
namespace {

using testing::HasSubstr;

double between(std::mt19937_64& engine, double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
}

std::vector<Point> random_cloud(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<Point> points(count);
    for (auto& p : points) p = {between(engine, -80, 80), between(engine, -100, 100), between(engine, -60, 10)};
    return points;
}

/// A lattice has ties everywhere.
std::vector<Point> lattice(int side) {
    std::vector<Point> points;
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) points.emplace_back(x, y, z);
    return points;
}

std::vector<PointIndex::Neighbour> by_brute_force(const std::vector<Point>& points, const Point& query) {
    std::vector<PointIndex::Neighbour> all;
    for (std::size_t i = 0; i < points.size(); ++i) all.push_back({i, (points[i] - query).norm()});
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
        return a.distance_mm < b.distance_mm || (a.distance_mm == b.distance_mm && a.index < b.index);
    });
    return all;
}

TEST(PointIndex, agrees_with_brute_force_on_a_random_cloud) {
    const auto points = random_cloud(3000, 1);
    const auto queries = random_cloud(200, 2);
    const PointIndex index(points);
    const auto batch = index.nearest(queries);
    for (std::size_t q = 0; q < queries.size(); ++q) {
        const auto expected = by_brute_force(points, queries[q]);
        EXPECT_EQ(index.nearest(queries[q]).index, expected[0].index);
        EXPECT_EQ(batch[q].index, expected[0].index);
        EXPECT_NEAR(batch[q].distance_mm, expected[0].distance_mm, 1e-12);  // rounding of a root of about 10 mm
        const auto few = index.nearest(queries[q], 7);
        ASSERT_EQ(few.size(), 7U);
        for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(few[k].index, expected[k].index);
        const auto near = index.within(queries[q], 15.0);
        ASSERT_LT(near.size(), expected.size());
        for (std::size_t k = 0; k < near.size(); ++k) EXPECT_EQ(near[k].index, expected[k].index);
        EXPECT_GT(expected[near.size()].distance_mm, 15.0);
    }
}

TEST(PointIndex, ties_go_to_the_lower_index_alone_and_in_a_batch) {
    const auto points = lattice(9);
    std::vector<Point> queries;
    queries.reserve(points.size());
    for (const auto& p : points) queries.push_back(p + Vector(0.5, 0.5, p.x() > 4 ? 0.5 : 0.0));  // 4 or 8 equal ones
    const PointIndex index(points);
    const auto batch = index.nearest(queries);
    for (std::size_t q = 0; q < queries.size(); ++q) {
        const auto expected = by_brute_force(points, queries[q]);
        EXPECT_EQ(index.nearest(queries[q]).index, expected[0].index);
        EXPECT_EQ(batch[q].index, expected[0].index);
        const auto few = index.nearest(queries[q], 3);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(few[k].index, expected[k].index);
    }
}

TEST(PointIndex, a_point_that_lies_on_the_radius_is_within_it) {
    const PointIndex index(lattice(3));
    EXPECT_EQ(index.within({1, 1, 1}, 1.0).size(), 7U);
    EXPECT_EQ(index.within({1, 1, 1}, 0.0).size(), 1U);
    EXPECT_EQ(index.within({1, 1, 1}, 0.999).size(), 1U);
}

TEST(PointIndex, a_thousand_equal_points_are_found_with_the_first_in_front) {
    const std::vector<Point> points(1000, Point(1, 2, 3));
    const PointIndex index(points);
    EXPECT_EQ(index.nearest(Point(0, 0, 0)).index, 0U);
    EXPECT_EQ(index.within(Point(1, 2, 3), 0.0).size(), 1000U);
    EXPECT_EQ(index.nearest(Point(1, 2, 3), 2000).size(), 1000U);
}

TEST(PointIndex, piles_of_equal_points_cost_a_search_no_more_than_single_points) {
    // One after another they would take 10^10 steps.
    constexpr std::size_t count = 100'000;
    const std::vector<Point> piles = {{0, 0, 0}, {1, 0, 0}, {0, 1, -0.0}};
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(piles[i % 3]);
    points.emplace_back(5, 5, 5);
    const PointIndex index(points);
    EXPECT_EQ(index.places(), 4U);
    for (std::size_t i = 0; i < count; ++i) {
        const auto few = index.nearest(points[i], 3);
        ASSERT_EQ(few.size(), 3U);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(few[k].index, i % 3 + 3 * k);
    }
    EXPECT_EQ(index.nearest(Point(5, 5, 5), count).size(), count);
    EXPECT_EQ(index.nearest(Point(5, 5, 5), 2)[1].index, 1U);  // as near as those of the third pile
    EXPECT_EQ(index.nearest(points)[7].index, 1U);
    const auto around = index.within(Point(0, 0, 0), 0.5);
    ASSERT_EQ(around.size(), count / 3 + 1);
    for (std::size_t k = 0; k < around.size(); ++k) EXPECT_EQ(around[k].index, 3 * k);
}

TEST(PointIndex, piles_among_other_points_change_no_answer) {
    auto points = random_cloud(2000, 7);
    for (std::size_t i = 0; i < 200; ++i) points[5 + 7 * i] = points[3];
    for (std::size_t i = 0; i < 40; ++i) points[6 + 9 * i] = points[1999];
    const PointIndex index(points);
    EXPECT_LT(index.places(), 1800U);
    auto queries = random_cloud(50, 8);
    queries.push_back(points[3]);
    queries.push_back(points[1999]);
    for (const auto& query : queries) {
        const auto expected = by_brute_force(points, query);
        EXPECT_EQ(index.nearest(query).index, expected[0].index);
        const auto few = index.nearest(query, 300);
        ASSERT_EQ(few.size(), 300U);
        for (std::size_t k = 0; k < 300; ++k) EXPECT_EQ(few[k].index, expected[k].index) << k;
    }
}

TEST(PointIndex, gives_the_same_answers_on_one_thread_and_on_two) {
    const auto points = random_cloud(5000, 3);
    const auto queries = random_cloud(5000, 4);
    const PointIndex index(points);
    base::set_thread_count(1);
    const auto one = index.nearest(queries);
    base::set_thread_count(2);
    const auto two = index.nearest(queries);
    base::set_thread_count(0);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].index, two[i].index);
        EXPECT_EQ(one[i].distance_mm, two[i].distance_mm);
    }
}

TEST(PointIndex, no_point_a_point_that_is_not_finite_and_a_bad_query_are_refused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(PointIndex(std::vector<Point>{}), InputError);
    try {
        const PointIndex index(std::vector<Point>{{0, 0, 0}, {0, nan, 0}});
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("point 1 "));
    }
    const PointIndex index(lattice(2));
    EXPECT_THROW((void)index.nearest(Point(0, 0, nan)), InputError);
    EXPECT_THROW((void)index.nearest(std::vector<Point>{{0, 0, nan}}), InputError);
    EXPECT_THROW((void)index.within(Point(0, 0, 0), -1), InputError);
    EXPECT_THROW((void)index.within(Point(0, 0, 0), nan), InputError);
}

}  // namespace
}  // namespace mimik::geometry
