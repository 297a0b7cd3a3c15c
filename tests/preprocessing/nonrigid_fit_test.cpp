#include "preprocessing/nonrigid_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::Triangle;

/// A square lattice over |x|, |y| <= half, `depth` above each place.
template <typename Depth>
std::pair<std::vector<Point>, std::vector<Triangle>> sheet(double half_mm, double step_mm, const Depth& depth) {
    const int count = static_cast<int>(std::lround(2 * half_mm / step_mm)) + 1;
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    for (int row = 0; row < count; ++row)
        for (int col = 0; col < count; ++col) {
            const double x = -half_mm + step_mm * col, y = -half_mm + step_mm * row;
            vertices.emplace_back(x, y, depth(x, y));
        }
    for (int row = 0; row + 1 < count; ++row)
        for (int col = 0; col + 1 < count; ++col) {
            const auto v = static_cast<std::uint32_t>(row * count + col), c = static_cast<std::uint32_t>(count);
            triangles.push_back({v, v + 1, v + c + 1});
            triangles.push_back({v, v + c + 1, v + c});
        }
    return {vertices, triangles};
}

double bowl(double x, double y) { return 5.0 - 0.004 * (x * x + y * y); }

TEST(NonrigidFit, lays_a_flat_sheet_on_a_bowl) {
    const auto [flat, faces] = sheet(30, 3, [](double, double) { return 0.0; });
    const auto [round, round_faces] = sheet(40, 1, bowl);
    const FitTarget target(round, round_faces);
    const auto fit = NonrigidFitter(flat, faces).fit(flat, target, {});
    EXPECT_EQ(fit.matched_share, 1.0);
    // The last stage still weighs differences a tenth of the data: of 7 mm of depth about a seventieth is left.
    EXPECT_LT(fit.residual_rms_mm, 0.15);
    EXPECT_GT(fit.vertices_mm[flat.size() / 2].z(), 4.5);  // the bowl's top is at 5
    EXPECT_LT(fit.vertices_mm.front().z(), 0.0);           // and its rim below 0
}

TEST(NonrigidFit, gives_the_same_bytes_again) {
    const auto [flat, faces] = sheet(30, 3, [](double, double) { return 0.0; });
    const auto [round, round_faces] = sheet(40, 1, bowl);
    const FitTarget target(round, round_faces);
    const NonrigidFitter fitter(flat, faces);
    EXPECT_EQ(fitter.fit(flat, target, {}).vertices_mm, fitter.fit(flat, target, {}).vertices_mm);
}

TEST(NonrigidFit, follows_a_mark_along_a_surface_that_says_nothing_of_it) {
    const auto [flat, faces] = sheet(30, 3, [](double, double) { return 0.0; });
    const FitTarget target(flat, faces);
    const auto middle = static_cast<std::uint32_t>(flat.size() / 2);
    const FitMark mark{{middle, middle, middle}, Eigen::Vector3d::UnitX(), Point(4, 0, 0), 100.0};
    const auto fit = NonrigidFitter(flat, faces).fit(flat, target, std::span(&mark, 1), {.point_share = 0.0});
    EXPECT_NEAR(fit.vertices_mm[middle].x(), 4.0, 0.1);  // 150 times the weight of a vertex
    EXPECT_NEAR(fit.vertices_mm[middle].z(), 0.0, 1e-6);
}

TEST(NonrigidFit, does_not_pull_in_what_lies_beyond_the_border_of_the_surface) {
    const auto [wide, faces] = sheet(30, 3, [](double, double) { return 0.0; });
    const auto [small, small_faces] = sheet(15, 1, [](double, double) { return 1.0; });
    const FitTarget target(small, small_faces);
    const auto fit = NonrigidFitter(wide, faces).fit(wide, target, {});
    for (std::size_t v = 0; v < wide.size(); ++v) {
        if (std::max(std::abs(wide[v].x()), std::abs(wide[v].y())) < 16) continue;
        EXPECT_FALSE(fit.matched[v]);
        // It goes along with the rest, 1 mm up, and not sideways to the border.
        EXPECT_LT((fit.vertices_mm[v] - wide[v] - Point(0, 0, 1)).norm(), 0.3);
    }
}

TEST(NonrigidFit, rims_may_lie_on_a_border) {
    const auto [sheet_mm, faces] = sheet(15, 3, [](double, double) { return 0.0; });
    const auto [wide, wide_faces] = sheet(17, 1, [](double, double) { return 0.0; });
    std::vector<std::uint8_t> on_rim(sheet_mm.size(), 1);
    std::vector<Point> outside = sheet_mm;
    for (auto& p : outside) p *= 1.2;  // its edge lies at 18 mm, the surface ends at 17
    const FitTarget target(wide, wide_faces);
    const NonrigidFitter fitter(sheet_mm, faces);
    EXPECT_LT(fitter.fit(outside, target, {}).matched_share, 1.0);
    EXPECT_EQ(fitter.fit(outside, target, {}, {}, {.on_rim = on_rim}).matched_share, 1.0);
}

TEST(NonrigidFit, stillness_holds_a_vertex_at_its_rest) {
    const auto [flat, faces] = sheet(30, 3, [](double, double) { return 0.0; });
    const auto [high, high_faces] = sheet(40, 1, [](double, double) { return 2.0; });
    const FitTarget target(high, high_faces);
    const auto fit = NonrigidFitter(flat, faces).fit(flat, target, {}, {.stillness = 1000.0}, {.rest_mm = flat});
    for (const auto& p : fit.vertices_mm) EXPECT_LT(std::abs(p.z()), 0.01);  // 2 mm at a thousandth of the weight
}

TEST(NonrigidFit, goes_from_the_first_smoothness_to_the_last_by_equal_ratios) {
    const NonrigidFitOptions options{.first_smoothness = 16, .last_smoothness = 0.25, .stages = 4};
    EXPECT_DOUBLE_EQ(options.smoothness(0), 16);
    EXPECT_DOUBLE_EQ(options.smoothness(1), 4);
    EXPECT_DOUBLE_EQ(options.smoothness(3), 0.25);
}

TEST(NonrigidFit, refuses_options_and_sizes_that_fit_nothing) {
    const auto [flat, faces] = sheet(9, 3, [](double, double) { return 0.0; });
    const FitTarget target(flat, faces);
    const NonrigidFitter fitter(flat, faces);
    EXPECT_THROW((void)fitter.fit(flat, target, {}, {.first_smoothness = 0}), InputError);
    EXPECT_THROW((void)fitter.fit(flat, target, {}, {.stages = 0}), InputError);
    EXPECT_THROW((void)fitter.fit(flat, target, {}, {.point_share = 2}), InputError);
    EXPECT_THROW((void)fitter.fit(std::span(flat).first(3), target, {}), InputError);
    EXPECT_THROW((void)fitter.fit(flat, target, {}, {}, {.rest_mm = std::span(flat).first(3)}), InputError);
}

}  // namespace
}  // namespace mimik::preprocessing
