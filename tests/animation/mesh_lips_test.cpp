#include "animation/mesh_lips.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace mimik::animation {
namespace {

using geometry::Point;
using preprocessing::LipSide;

/// Two sheets of 5 x 9 vertices, 1 mm apart in x and 1.5 mm in y, that touch at y = 0: an upper and a lower lip.
struct Lips {
    static constexpr std::uint32_t columns = 5, rows = 9;
    std::vector<Point> vertices_mm;
    std::vector<geometry::Triangle> triangles;
    std::vector<double> shares;
    Lips() {
        for (const double up : {1.0, -1.0}) {
            const auto first = static_cast<std::uint32_t>(vertices_mm.size());
            for (std::uint32_t r = 0; r < rows; ++r)
                for (std::uint32_t c = 0; c < columns; ++c) {
                    const double from_cut_mm = 1.5 * r;
                    vertices_mm.emplace_back(c, up * from_cut_mm, 0);
                    shares.push_back(up * std::max(0.0, 1.0 - from_cut_mm / 12.0));
                }
            for (std::uint32_t r = 0; r + 1 < rows; ++r)
                for (std::uint32_t c = 0; c + 1 < columns; ++c) {
                    const auto v = first + r * columns + c;
                    triangles.push_back({v, v + 1, v + columns});
                    triangles.push_back({v + 1, v + columns + 1, v + columns});
                }
        }
    }
    [[nodiscard]] static bool upper(std::uint32_t v) { return v < rows * columns; }
};

TEST(MeshLips, vertices_that_are_nearest_to_the_wrong_lip_are_of_the_one_that_they_hang_on) {
    Lips lips;
    lips.shares[2] = -0.95;                              // of the upper lip's rim, taken for the lower one
    lips.shares[Lips::rows * Lips::columns + 3] = 0.99;  // and the other way round
    const auto sides = lip_sides_along(lips.vertices_mm, lips.triangles, lips.shares);
    for (std::uint32_t v = 0; v < sides.size(); ++v)
        EXPECT_EQ(sides[v], lips.shares[v] == 0 ? LipSide::neither
                            : Lips::upper(v)    ? LipSide::upper
                                                : LipSide::lower)
            << v;
}

TEST(MeshLips, a_part_that_hangs_on_no_lip_is_of_the_nearest) {
    Lips lips;
    const auto first = static_cast<std::uint32_t>(lips.vertices_mm.size());
    for (const double x : {0.0, 1.0, 2.0}) {
        lips.vertices_mm.emplace_back(x, -1, -5);
        lips.shares.push_back(-0.9);
    }
    lips.triangles.push_back({first, first + 1, first + 2});
    const auto sides = lip_sides_along(lips.vertices_mm, lips.triangles, lips.shares);
    for (auto v = first; v < first + 3; ++v) EXPECT_EQ(sides[v], LipSide::lower);
}

TEST(MeshLips, single_teeth_of_the_line_between_lips_go_to_the_lip_that_they_stick_into) {
    // Rows 0 to 3 are the lower lip, 4 to 7 the upper; beside the mouth lies neither.
    constexpr int rows = 8, cols = 16;
    std::vector<LipSide> clean(static_cast<std::size_t>(rows * cols), LipSide::neither);
    for (int row = 0; row < rows; ++row)
        for (int col = 2; col < cols - 2; ++col)
            clean[static_cast<std::size_t>(row * cols + col)] = row < 4 ? LipSide::lower : LipSide::upper;
    auto noisy = clean;
    noisy[4 * cols + 7] = noisy[4 * cols + 8] = LipSide::lower;  // two wide, one high
    noisy[3 * cols + 4] = LipSide::upper;
    noisy[6 * cols + 10] = LipSide::lower;  // an island
    EXPECT_EQ(evened_lip_sides(noisy, {rows, cols}), clean);
    EXPECT_EQ(evened_lip_sides(clean, {rows, cols}), clean);
}

}  // namespace
}  // namespace mimik::animation
