#include "geometry/spikes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mimik::geometry {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A level lattice of points 1 mm apart.
RangeScan level(int rows = 12, int cols = 12) {
    RangeScan scan;
    scan.rows = rows;
    scan.cols = cols;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) scan.points_mm.emplace_back(col, row, 0);
    return scan;
}
RangeScan cloud_of(RangeScan scan) {
    scan.rows = scan.cols = 0;
    return scan;
}
RangeScan mesh_of(RangeScan scan) {
    const auto cols = static_cast<std::uint32_t>(scan.cols);
    for (std::uint32_t v = 0; v + cols < scan.points_mm.size(); ++v)
        if ((v + 1) % cols != 0) scan.faces.add(std::array{v, v + 1, v + cols + 1, v + cols});
    return cloud_of(std::move(scan));
}

std::vector<std::size_t> spikes_of(const RangeScan& scan) {
    const auto mask = find_spikes(scan, scan_neighbours(scan), 4.0);
    std::vector<std::size_t> spikes;
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask[i]) spikes.push_back(i);
    return spikes;
}

TEST(Spikes, are_the_points_off_the_median_of_their_neighbours_in_lattice_mesh_and_cloud) {
    auto scan = level();
    EXPECT_THAT(spikes_of(scan), IsEmpty());
    scan.points_mm[65].z() = 4.1;
    EXPECT_THAT(spikes_of(scan), ElementsAre(65U));
    EXPECT_THAT(spikes_of(mesh_of(scan)), ElementsAre(65U));
    scan.points_mm[65].z() = 3.9;
    EXPECT_THAT(spikes_of(scan), IsEmpty());
    // A cloud's neighbours lie within three times its spacing: closer than the limit here.
    auto dense = level();
    for (auto& p : dense.points_mm) p.head<2>() *= 2;
    dense.points_mm[65].z() = 4.1;
    EXPECT_THAT(spikes_of(cloud_of(dense)), ElementsAre(65U));
}

TEST(Spikes, a_straight_step_has_none) {
    auto scan = level();
    for (auto& p : scan.points_mm)
        if (p.x() >= 6) p.z() = 30;
    EXPECT_THAT(spikes_of(scan), IsEmpty());
}

TEST(Spikes, a_steep_side_of_a_coarse_mesh_is_none) {
    auto scan = level();
    for (auto& p : scan.points_mm) p.head<2>() *= 10;
    scan.points_mm[65].z() = 15;  // twice the 10 mm to its neighbours is the limit
    EXPECT_THAT(spikes_of(mesh_of(scan)), IsEmpty());
    EXPECT_THAT(spikes_of(scan), ElementsAre(65U));
}

TEST(Spikes, a_point_with_fewer_than_three_neighbours_cannot_be_judged) {
    auto cloud = cloud_of(level());
    cloud.points_mm.emplace_back(5, 5, 150);
    EXPECT_THAT(spikes_of(cloud), IsEmpty());
}

TEST(ScanNeighbours, of_a_lattice_are_two_rings_without_what_was_not_measured) {
    auto scan = level();
    scan.points_mm[0].setConstant(std::numeric_limits<double>::quiet_NaN());
    const auto neighbours = scan_neighbours(scan);
    EXPECT_EQ(neighbours[65].size(), 24U);
    EXPECT_EQ(neighbours[1].size(), 10U);  // three columns of three and two more, less itself and the lost corner
    EXPECT_TRUE(neighbours[0].empty());
}

TEST(ScanNeighbours, of_points_at_one_place_the_first_stands_for_all) {
    auto cloud = cloud_of(level());
    cloud.points_mm.push_back(cloud.points_mm[65]);
    const auto neighbours = scan_neighbours(cloud);
    EXPECT_EQ(neighbours.first_of_place[144], 65U);
    EXPECT_THAT(neighbours[144], ElementsAre(65U));
    EXPECT_TRUE(std::none_of(neighbours[64].begin(), neighbours[64].end(), [](auto v) { return v == 144; }));
}

TEST(ScanNeighbours, of_a_scan_without_a_measured_point_are_none) {
    auto scan = cloud_of(level(2, 2));
    for (auto& p : scan.points_mm) p.setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THAT(spikes_of(scan), IsEmpty());
}

}  // namespace
}  // namespace mimik::geometry
