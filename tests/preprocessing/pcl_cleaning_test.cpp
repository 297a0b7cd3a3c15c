#include "preprocessing/pcl_cleaning.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/companion.h"
#include "base/errors.h"
#include "base/pcl_module.h"
#include "tests/support/analytic_face.h"
#include "tests/support/thrown.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::RangeScan;
using ::testing::HasSubstr;

std::size_t valid_points(const RangeScan& scan) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < scan.points_mm.size(); ++i) count += scan.valid(i) ? 1 : 0;
    return count;
}

/// Borders stay: their points lie farther from their neighbours than those inside, as an outlier does.
PclCleaningOptions lenient() {
    PclCleaningOptions options;
    options.deviations = 12;
    return options;
}

class PclCleaning : public testing::Test {
protected:
    void SetUp() override {
        if (base::find_companion(base::pcl_module_name).empty())
            GTEST_SKIP() << "mimik-pcl.so is not built: scripts/setup.sh --adapters installs PCL";
    }
};

TEST_F(PclCleaning, takes_out_what_lies_off_and_nothing_else) {
    auto scan = test::AnalyticFace{}.scan();
    const auto at = [&](int row, int col) { return static_cast<std::size_t>(row * scan.cols + col); };
    const std::size_t spikes[] = {at(60, 60), at(60, 61), at(100, 80), at(140, 75)};
    for (const auto i : spikes) scan.points_mm[i].z() += 40;
    CleaningReport report;
    const auto cleaned = clean_with_pcl(scan, lenient(), &report);
    EXPECT_EQ(report.spikes, 4U);
    EXPECT_EQ(report.kept, report.points - 4);
    for (const auto i : spikes) EXPECT_FALSE(cleaned.valid(i));
    EXPECT_EQ(cleaned.rows, scan.rows);
}

/// Which points lie farther from their neighbours than the mean of all and `deviations` standard deviations.
std::vector<double> excess_by_definition(const std::vector<Point>& points, const PclCleaningOptions& options) {
    const auto k = static_cast<std::size_t>(options.neighbours);
    std::vector<double> means, distances;
    for (const auto& p : points) {
        distances.clear();
        for (const auto& q : points) distances.push_back((p - q).norm());
        std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(k + 1), distances.end());
        double sum = 0;
        for (std::size_t i = 1; i <= k; ++i) sum += distances[i];
        means.push_back(sum / static_cast<double>(k));
    }
    double mean = 0, squares = 0;
    for (const double m : means) mean += m / static_cast<double>(means.size());
    for (const double m : means) squares += (m - mean) * (m - mean);
    const double limit = mean + options.deviations * std::sqrt(squares / static_cast<double>(means.size() - 1));
    for (auto& m : means) m -= limit;
    return means;
}

TEST_F(PclCleaning, outliers_are_those_of_the_definition) {
    RangeScan cloud;
    for (int k = 0; k < 900; ++k) {  // a wavy sheet, denser on one side
        const double x = std::pow(k % 30 / 29.0, 1.5) * 40, y = k / 30;
        cloud.points_mm.emplace_back(x, y, 2 * std::sin(0.3 * x + 0.2 * y));
    }
    PclCleaningOptions options;
    options.neighbours = 8;
    options.deviations = 1;
    options.tolerance_mm = 50;
    options.min_part = 0;
    const auto excess = excess_by_definition(cloud.points_mm, options);
    const auto cleaned = clean_with_pcl(cloud, options);
    EXPECT_LT(cleaned.points_mm.size(), cloud.points_mm.size() - 50);
    for (std::size_t i = 0; i < excess.size(); ++i) {
        if (std::abs(excess[i]) < 1e-4) continue;  // single precision may see it the other way round
        const bool stayed = std::find(cleaned.points_mm.begin(), cleaned.points_mm.end(), cloud.points_mm[i]) !=
                            cleaned.points_mm.end();
        EXPECT_EQ(stayed, excess[i] < 0) << i;
    }
}

TEST_F(PclCleaning, takes_out_a_stray_tuft_and_a_wall_behind_the_head) {
    auto scan = test::AnalyticFace{}.scan();
    const auto face_points = valid_points(scan);
    for (int row = 0; row < scan.rows; ++row)
        for (int col = 0; col < scan.cols; ++col) {
            auto& p = scan.points_mm[static_cast<std::size_t>(row * scan.cols + col)];
            if (!p.allFinite()) p = Point(-75 + col, -85 + row, -600);
        }
    for (int row = 0; row < 8; ++row)
        for (int col = 0; col < 8; ++col)
            scan.points_mm[static_cast<std::size_t>(row * scan.cols + col)] = Point(-75 + col, -85 + row, 40);
    CleaningReport report;
    const auto cleaned = clean_with_pcl(scan, lenient(), &report);
    EXPECT_EQ(valid_points(cleaned), face_points);
    EXPECT_GE(report.stray_parts, 2U);
    EXPECT_EQ(report.kept, face_points);
    EXPECT_LT(report.spikes, 20U);  // of the wall, where it is a strip of three columns beside the face
}

TEST_F(PclCleaning, parts_are_as_far_apart_as_the_tolerance_says) {
    RangeScan cloud;
    for (int k = 0; k < 400; ++k) cloud.points_mm.emplace_back(k % 20, k / 20, 0);
    for (int k = 0; k < 100; ++k) cloud.points_mm.emplace_back(k % 10 + 24, k / 10, 0);  // a gap of 5 mm
    auto options = lenient();
    options.min_part = 0.5;
    for (const double tolerance_mm : {4.9, 5.1}) {
        options.tolerance_mm = tolerance_mm;
        CleaningReport report;
        EXPECT_EQ(clean_with_pcl(cloud, options, &report).points_mm.size(), tolerance_mm < 5 ? 400U : 500U);
        EXPECT_EQ(report.stray_points, tolerance_mm < 5 ? 100U : 0U);
    }
}

TEST_F(PclCleaning, points_at_one_place_count_once) {
    RangeScan cloud;
    for (int k = 0; k < 400; ++k) cloud.points_mm.emplace_back(k % 20, k / 20, 0);
    for (int k = 0; k < 20000; ++k) cloud.points_mm.emplace_back(100, 100, 0);
    auto options = lenient();
    options.deviations = 1e6;
    CleaningReport report;
    EXPECT_EQ(clean_with_pcl(cloud, options, &report).points_mm.size(), 400U);
    EXPECT_EQ(report.stray_points, 20000U);
    EXPECT_EQ(report.stray_parts, 1U);
}

TEST_F(PclCleaning, where_the_frame_has_its_origin_is_of_no_matter) {
    auto near = test::AnalyticFace{}.scan();
    for (const int row : {60, 100, 140}) near.points_mm[static_cast<std::size_t>(row * near.cols + 70)].z() += 40;
    auto far = near;
    for (auto& p : far.points_mm) p += geometry::Vector(1e7, -2e7, 3e7);  // 10 km and more
    CleaningReport of_near, of_far;
    const auto kept_near = clean_with_pcl(near, lenient(), &of_near),
               kept_far = clean_with_pcl(far, lenient(), &of_far);
    EXPECT_EQ(of_near.spikes, 3U);
    EXPECT_EQ(of_far.spikes, of_near.spikes);
    EXPECT_EQ(of_far.stray_points, of_near.stray_points);
    EXPECT_EQ(kept_far.points_mm.size(), kept_near.points_mm.size());
}

TEST_F(PclCleaning, a_scan_without_a_measured_point_is_refused) {
    RangeScan nothing;
    nothing.points_mm.emplace_back(NAN, NAN, NAN);
    EXPECT_THAT(test::message_of([&] { (void)clean_with_pcl(nothing); }), HasSubstr("no measured point"));
}

TEST(PclCleaningOptions, what_cannot_be_is_refused_by_name) {
    const auto said = [](const PclCleaningOptions& options) { return test::message_of([&] { options.check(); }); };
    PclCleaningOptions options;
    options.neighbours = 0;
    EXPECT_THAT(said(options), HasSubstr("neighbours is 0"));
    options = {};
    options.deviations = std::nan("");
    EXPECT_THAT(said(options), HasSubstr("deviations is nan"));
    options = {};
    options.tolerance_mm = -1;
    EXPECT_THAT(said(options), HasSubstr("tolerance_mm is -1"));
    options.tolerance_mm = 51;
    EXPECT_THAT(said(options), HasSubstr("up to 50"));
    EXPECT_THAT(test::message_of([] { (void)parse_cleaning_method("pvl"); }), HasSubstr("give own or pcl"));
}

}  // namespace
}  // namespace mimik::preprocessing
