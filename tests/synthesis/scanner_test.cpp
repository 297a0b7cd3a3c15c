#include "synthesis/scanner.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "synthesis/depth_raster.h"
#include "tests/synthesis/dome_model.h"

namespace mimik::synthesis {
namespace {

ScannerOptions ideal() {
    ScannerOptions options;
    options.noise_z_mm = options.smooth_noise_z_mm = options.noise_xy_mm = 0;
    options.pitch_deg = options.yaw_deg = options.roll_deg = options.translation_mm = 0;
    options.eye_hole_share = options.nostril_hole_share = options.brow_hole_share = 0;
    options.marking_jitter = 0;
    return options;
}

SyntheticScan scan_dome(const ScannerOptions& options, std::uint64_t seed = 1) {
    const auto model = make_dome_model();
    const auto face = model->neutral_mm({Sex::female, 0, {0.0}, {}});
    return scan_face(*model, face, face_window(*model, face), "bs000_N_N_0", seed, options);
}

TEST(Scanner, an_ideal_scanner_measures_the_surface_itself) {
    const auto made = scan_dome(ideal());
    EXPECT_GT(made.valid_points, 20000U);
    for (std::size_t i = 0; i < made.scan.points_mm.size(); ++i) {
        if (!made.scan.valid(i)) continue;
        const auto& p = made.scan.points_mm[i];
        // Between the model's vertices, 3 mm apart, its chords lie up to 2 * 1.5^2 / 100 mm below the paraboloid.
        ASSERT_NEAR(p.z(), 100.0 - (p.x() * p.x() + p.y() * p.y()) / 100.0, 0.0451);
    }
}

TEST(Scanner, noise_has_the_deviation_asked_for) {
    auto options = ideal();
    options.noise_z_mm = 0.13;
    const auto noisy = scan_dome(options), clean = scan_dome(ideal());
    double squares = 0;
    for (std::size_t i = 0; i < noisy.scan.points_mm.size(); ++i) {
        ASSERT_EQ(noisy.scan.valid(i), clean.scan.valid(i));
        if (noisy.scan.valid(i)) squares += std::pow(noisy.scan.points_mm[i].z() - clean.scan.points_mm[i].z(), 2);
    }
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(noisy.valid_points)), 0.13, 0.003);  // four standard errors
}

TEST(Scanner, landmarks_are_vertices_of_the_scan_near_the_truth) {
    const auto made = scan_dome(ScannerOptions{});
    EXPECT_EQ(made.landmarks.size(), 22U);
    for (const auto& mark : made.landmarks.all()) {
        const bool vertex = std::any_of(made.scan.points_mm.begin(), made.scan.points_mm.end(),
                                        [&](const auto& p) { return p == mark.position_mm; });
        EXPECT_TRUE(vertex) << mark.name;
        EXPECT_LT((mark.position_mm - made.true_landmarks.position_mm(mark.name)).norm(), 6.0) << mark.name;
    }
}

TEST(Scanner, holes_take_their_share_of_the_region_and_spikes_are_counted) {
    auto options = ideal();
    options.eye_hole_share = 1.0;
    options.spikes = 7;
    const auto made = scan_dome(options), clean = scan_dome(ideal());
    EXPECT_EQ(made.lost_holes + made.valid_points, clean.valid_points);
    EXPECT_GT(made.lost_holes, 300U);  // two lids of 24 x 10 mm at 0.77 mm would be 800 points
    int spikes = 0;
    for (std::size_t i = 0; i < made.scan.points_mm.size(); ++i)
        if (made.scan.valid(i) && std::abs(made.scan.points_mm[i].z() - clean.scan.points_mm[i].z()) >= 5.0) ++spikes;
    EXPECT_EQ(spikes, 7);
}

TEST(DepthRaster, the_nearer_of_two_surfaces_is_met_and_its_side_told) {
    const std::vector<geometry::Point> points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 5}, {0, 4, 5}, {4, 0, 5}};
    const std::vector<geometry::Triangle> triangles = {{0, 1, 2}, {3, 4, 5}};
    const auto hits = depth_raster(points, triangles, {1.0, 1.0, 10.0, 1, 2});
    ASSERT_EQ(hits.size(), 2U);
    EXPECT_EQ(hits[0].triangle, 1U);
    EXPECT_DOUBLE_EQ(hits[0].z_mm, 5.0);
    EXPECT_FALSE(hits[0].front);
    EXPECT_FALSE(hits[1].hit());
}

TEST(ScannerOptions, a_value_out_of_range_is_named) {
    ScannerOptions options;
    options.spacing_mm = 0;
    try {
        options.check();
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("spacing_mm is 0"));
    }
}

}  // namespace
}  // namespace mimik::synthesis
