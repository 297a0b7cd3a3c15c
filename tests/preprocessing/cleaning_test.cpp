#include "preprocessing/cleaning.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "database/doctor.h"
#include "tests/support/analytic_face.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::RangeScan;

std::size_t valid_points(const RangeScan& scan) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i) count += scan.valid(i) ? 1 : 0;
    return count;
}

TEST(Cleaning, leaves_a_clean_face_as_it_is) {
    const auto scan = test::AnalyticFace{}.scan();
    CleaningReport report;
    const auto cleaned = clean(scan, {}, &report);
    EXPECT_EQ(valid_points(cleaned), valid_points(scan));
    EXPECT_EQ(report.spikes + report.stray_points, 0U);
}

TEST(Cleaning, takes_out_exactly_the_spikes_that_were_put_in) {
    auto scan = test::AnalyticFace{}.scan();
    const auto at = [&](int row, int col) { return static_cast<std::size_t>(row * scan.cols + col); };
    const std::size_t spikes[] = {at(60, 60), at(60, 61), at(100, 80), at(140, 75)};
    for (const auto i : spikes) scan.points_mm[i].z() += 12;
    CleaningReport report;
    const auto cleaned = clean(scan, {}, &report);
    EXPECT_EQ(report.spikes, 4U);
    for (const auto i : spikes) EXPECT_FALSE(cleaned.valid(i));

    // The doctor counts by the same rule and the same limit.
    EXPECT_EQ(database::DoctorOptions{}.spike_mm, CleaningOptions{}.spike_mm);
    database::LoadedScan loaded;
    loaded.scan = scan;
    const auto findings = database::check_scan(loaded);
    EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const auto& finding) {
        return finding.kind == "spikes" && finding.what.starts_with("4 points");
    }));
}

TEST(Cleaning, takes_out_a_stray_tuft_and_a_wall_behind_the_head) {
    auto scan = test::AnalyticFace{}.scan();
    const auto face_points = valid_points(scan);
    for (int row = 0; row < 8; ++row)
        for (int col = 0; col < 8; ++col)
            scan.points_mm[static_cast<std::size_t>(row * scan.cols + col)] = Point(-75 + col, -85 + row, 20);
    for (int row = 0; row < scan.rows; ++row)
        for (int col = 0; col < scan.cols; ++col) {
            auto& p = scan.points_mm[static_cast<std::size_t>(row * scan.cols + col)];
            if (!p.allFinite()) p = Point(-75 + col, -85 + row, -600);
        }
    CleaningReport report;
    const auto cleaned = clean(scan, {}, &report);
    EXPECT_EQ(valid_points(cleaned), face_points);
    EXPECT_GE(report.stray_parts, 2U);
}

TEST(Cleaning, a_cloud_loses_the_same_spikes_as_the_lattice) {
    auto scan = test::AnalyticFace{}.scan();
    scan.points_mm[static_cast<std::size_t>(60 * scan.cols + 60)].z() += 15;
    RangeScan cloud;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i)) cloud.points_mm.push_back(scan.points_mm[i]);
    EXPECT_EQ(clean(cloud).points_mm.size(), cloud.points_mm.size() - 1);
}

TEST(Cleaning, the_coarse_half_of_a_mesh_stays_with_the_fine_one) {
    using Face = test::AnalyticFace;
    auto x = Face::lines(-60, 0, 1);
    for (const double coarse : Face::lines(9, 63, 9)) x.push_back(coarse);
    auto mesh = Face{}.mesh(x, Face::lines(-60, 72, 6));
    CleaningReport report;
    EXPECT_EQ(clean(mesh, {}, &report).points_mm.size(), mesh.points_mm.size());
    EXPECT_EQ(report.spikes + report.stray_points, 0U);
    mesh.points_mm[x.size() * 10 + 30].z() += 15;  // in the fine half
    mesh.points_mm.push_back(Point(0, 0, 60));     // no face has it
    EXPECT_EQ(clean(mesh, {}, &report).faces.size(), mesh.faces.size() - 4);
    EXPECT_EQ(report.spikes, 1U);
    EXPECT_EQ(report.stray_points, 1U);
}

TEST(Cleaning, a_mesh_hangs_together_over_its_texture_seams) {
    // The corners of each quad are its own vertices, as where every face has its own place in the image.
    const auto mesh = test::AnalyticFace{}.mesh({-4, -2, 0, 2, 4}, {30, 32, 34});
    RangeScan apart;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        std::vector<std::uint32_t> corners;
        for (const auto v : mesh.faces[f]) {
            corners.push_back(static_cast<std::uint32_t>(apart.points_mm.size()));
            apart.points_mm.push_back(mesh.points_mm[v]);
        }
        apart.faces.add(corners);
    }
    CleaningReport report;
    CleaningOptions options;
    options.min_part = 0.5;
    EXPECT_EQ(clean(apart, options, &report).points_mm.size(), 32U);  // 8 quads
    EXPECT_EQ(report.stray_parts, 0U);
}

TEST(Cleaning, a_hundred_thousand_points_at_one_place_count_once) {
    // As a depth camera writes what it did not measure. All pairs of them would be 10^10 neighbours.
    RangeScan cloud;
    cloud.points_mm.assign(100'000, Point(0, 0, -1000));
    const auto scan = test::AnalyticFace{}.scan(2.0);
    std::size_t face_points = 0;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i)) {
            cloud.points_mm.push_back(scan.points_mm[i]);
            ++face_points;
        }
    CleaningReport report;
    EXPECT_EQ(clean(cloud, {}, &report).points_mm.size(), face_points);
    EXPECT_EQ(report.stray_points, 100'000U);
    EXPECT_EQ(report.stray_parts, 1U);
}

TEST(Cleaning, a_scan_without_a_point_is_refused) {
    RangeScan scan;
    EXPECT_THROW((void)clean(scan), InputError);
}

}  // namespace
}  // namespace mimik::preprocessing
