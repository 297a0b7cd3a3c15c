#include "capture/minimise_surface.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/no_companions.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using geometry::Point;
using testing::AllOf;
using testing::HasSubstr;

/// A patch of 4 x 4 vertices, 10 mm apart, above a wavy sheet.
struct Patch {
    std::vector<Point> rest, sheet, start;
    std::vector<geometry::Triangle> triangles, sheet_triangles;
    std::vector<std::uint8_t> holding;

    Patch() {
        grid(4, 10, rest, triangles, 0);
        grid(41, 1, sheet, sheet_triangles, 2);
        start = rest;
        for (std::size_t v = 0; v < start.size(); ++v)
            start[v] += Point(std::sin(3.0 * static_cast<double>(v)), std::cos(5.0 * static_cast<double>(v)), 1.5);
        holding.assign(rest.size(), 0);
        holding.front() = holding.back() = 1;
    }
    static void grid(std::uint32_t side, double width, std::vector<Point>& points,
                     std::vector<geometry::Triangle>& faces, double wave) {
        for (std::uint32_t row = 0; row < side; ++row)
            for (std::uint32_t column = 0; column < side; ++column)
                points.emplace_back(width * column, width * row, wave * std::sin(width * column / 6));
        for (std::uint32_t row = 0; row + 1 < side; ++row)
            for (std::uint32_t column = 0; column + 1 < side; ++column) {
                const auto a = row * side + column;
                faces.push_back({a, a + 1, a + side + 1});
                faces.push_back({a, a + side + 1, a + side});
            }
    }
};

TEST(MinimiseSurface, a_library_that_is_not_there_is_named_with_its_package) {
    const test::NoCompanions none;
    const Patch patch;
    const geometry::SurfaceIndex target(patch.sheet, patch.sheet_triangles);
    const SurfaceEnergy energy(patch.rest, patch.triangles, target);
    EXPECT_TRUE(is_there(SurfaceMinimiser::levenberg));
    EXPECT_FALSE(is_there(SurfaceMinimiser::ceres));
    EXPECT_FALSE(is_there(SurfaceMinimiser::simplex));
    const auto refusal = [&](SurfaceMinimiser by) {
        return test::message_of([&] { (void)minimise_surface(energy, patch.start, {}, by); });
    };
    EXPECT_THAT(refusal(SurfaceMinimiser::ceres),
                AllOf(HasSubstr("mimik-ceres.so is not there"), HasSubstr("libceres-dev"), HasSubstr("levenberg")));
    EXPECT_THAT(refusal(SurfaceMinimiser::simplex), HasSubstr("libopencv-dev"));
}

TEST(MinimiseSurface, least_squares_end_no_higher_than_the_simplex_and_what_holds_stays) {
    const Patch patch;
    const geometry::SurfaceIndex target(patch.sheet, patch.sheet_triangles);
    const SurfaceEnergy energy(patch.rest, patch.triangles, target);
    MinimiseSurfaceOptions options;
    options.most_evaluations = 20000;  // of 42 variables
    double simplex = 1e9;
    for (const auto by : {SurfaceMinimiser::simplex, SurfaceMinimiser::ceres, SurfaceMinimiser::levenberg}) {
        if (!is_there(by)) continue;
        const auto found = minimise_surface(energy, patch.start, patch.holding, by, options);
        EXPECT_LT(found.end.total, 0.8 * found.start.total) << to_string(by);
        EXPECT_EQ(found.end.total, energy.of(found.pose_mm).total) << to_string(by);
        EXPECT_EQ(found.pose_mm.front(), patch.start.front()) << to_string(by);
        EXPECT_EQ(found.pose_mm.back(), patch.start.back()) << to_string(by);
        EXPECT_GT(found.evaluations, 1U);
        if (by == SurfaceMinimiser::simplex)
            simplex = found.end.total;
        else
            EXPECT_LE(found.end.total, simplex) << to_string(by);
        const auto again = minimise_surface(energy, patch.start, patch.holding, by, options);
        EXPECT_EQ(again.pose_mm, found.pose_mm) << "the same input, the same bytes: " << to_string(by);
    }
}

TEST(MinimiseSurface, ceres_and_levenberg_find_the_same_energy) {
    if (!is_there(SurfaceMinimiser::ceres))
        GTEST_SKIP() << "mimik-ceres.so is not built: scripts/setup.sh --adapters installs Ceres";
    const Patch patch;
    const geometry::SurfaceIndex target(patch.sheet, patch.sheet_triangles);
    const SurfaceEnergy energy(patch.rest, patch.triangles, target);
    const auto ceres = minimise_surface(energy, patch.start, patch.holding, SurfaceMinimiser::ceres);
    const auto own = minimise_surface(energy, patch.start, patch.holding, SurfaceMinimiser::levenberg);
    // Corners of sizes are round within 0.01 mm, and both stop by shares of what is left.
    EXPECT_NEAR(ceres.end.total, own.end.total, 0.02);
}

TEST(MinimiseSurface, one_triangle_goes_to_its_target_by_fewer_terms_than_variables) {
    const Patch patch;
    const geometry::SurfaceIndex target(patch.sheet, patch.sheet_triangles);
    const std::vector<Point> triangle = {patch.sheet[0], patch.sheet[10], patch.sheet[410]};
    auto start = triangle;
    for (auto& p : start) p.z() += 3;
    const SurfaceEnergy energy(triangle, std::vector<geometry::Triangle>{{0, 1, 2}}, target);
    for (const auto by : {SurfaceMinimiser::levenberg, SurfaceMinimiser::ceres}) {
        if (!is_there(by)) continue;
        // Six terms and nine variables; what is left is of the last width, 0.01 mm.
        EXPECT_LT(minimise_surface(energy, start, {}, by).end.total, 0.01) << to_string(by);
    }
}

TEST(MinimiseSurface, where_all_holds_the_start_is_the_end) {
    const Patch patch;
    const geometry::SurfaceIndex target(patch.sheet, patch.sheet_triangles);
    const SurfaceEnergy energy(patch.rest, patch.triangles, target);
    const std::vector<std::uint8_t> all(patch.rest.size(), 1);
    const auto found = minimise_surface(energy, patch.start, all, SurfaceMinimiser::levenberg);
    EXPECT_EQ(found.pose_mm, patch.start);
    EXPECT_EQ(found.end.total, found.start.total);
    const std::vector<std::uint8_t> few(3, 1);
    EXPECT_THAT(
        test::message_of([&] { (void)minimise_surface(energy, patch.start, few, SurfaceMinimiser::levenberg); }),
        HasSubstr("16 points begin and 3 are said to hold; the surface has 16 vertices"));
}

}  // namespace
}  // namespace mimik::capture
