#include "preprocessing/bake_texture.h"

#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mimik::preprocessing {
namespace {

using geometry::QuadGrid;
using geometry::TextureCoordinate;
using geometry::VertexOrigin;
using Rgb = std::array<int, 3>;

/// A flat grid of 10 x 10 vertices, 1 mm apart, without its vertex in the corner of row 9 and column 9.
QuadGrid flat_grid() {
    QuadGrid grid;
    grid.rows = grid.cols = 10;
    for (int row = 0; row < 10; ++row)
        for (int col = 0; col < 10; ++col) grid.vertices_mm.emplace_back(col, row, 0);
    grid.origin.assign(100, VertexOrigin::measured);
    grid.origin.back() = VertexOrigin::outside;
    grid.vertices_mm.back().z() = std::nan("");
    return grid;
}

/// The left half of the face lies in the right half of an atlas and the right half in the left, with a black gap.
geometry::TextureCharts crossed_charts() {
    geometry::TextureCharts charts;
    charts.points_mm = {{0, 0, 0}, {4.5, 0, 0}, {9, 0, 0}, {0, 9, 0}, {4.5, 9, 0}, {9, 9, 0}};
    charts.faces.add(std::array<std::uint32_t, 4>{0, 1, 4, 3});
    charts.faces.add(std::array<std::uint32_t, 4>{1, 2, 5, 4});
    charts.faces.texture_corners = {0, 1, 2, 3, 4, 5, 6, 7};
    charts.positions = {{0.6, 0}, {1, 0}, {1, 1}, {0.6, 1}, {0, 0}, {0.4, 0}, {0.4, 1}, {0, 1}};
    charts.images = {"a.png"};
    return charts;
}

/// 10 x 10 pixels: columns 0 to 3 green, 4 and 5 black, 6 to 9 red; lower rows are darker.
io::Image crossed_image() {
    io::Image image{10, 10, {}};
    for (int row = 0; row < 10; ++row)
        for (int col = 0; col < 10; ++col) {
            const auto light = static_cast<std::uint8_t>(250 - 10 * row);
            const std::array<std::uint8_t, 3> colour = {col > 5 ? light : std::uint8_t{0},
                                                        col < 4 ? light : std::uint8_t{0}, 0};
            image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
        }
    return image;
}

Rgb pixel(const io::Image& image, int x, int y) {
    const auto at = 3 * static_cast<std::size_t>(y * image.width + x);
    return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// What a viewer shows at a vertex.
Rgb at_vertex(const io::Image& image, const QuadGrid& grid, int row, int col) {
    const auto& uv = grid.texture_coordinates[grid.index(row, col)];
    return pixel(image, static_cast<int>(uv.x() * image.width), static_cast<int>((1 - uv.y()) * image.height));
}

TEST(BakedTexture, has_the_colour_of_the_scan_at_every_vertex_and_no_seam_between_charts) {
    auto grid = flat_grid();
    const std::vector<std::optional<io::Image>> images = {crossed_image()};
    const auto picture = bake_texture(crossed_charts(), images, grid);
    EXPECT_EQ(picture.width, 80);
    for (int row = 0; row < 9; ++row)
        for (int col = 0; col < 9; ++col) {
            const auto colour = at_vertex(picture, grid, row, col);
            const double light = 160 + 100 * row / 9.0 - 5;  // pixel centres are half a pixel inside
            EXPECT_NEAR(colour[col < 5 ? 0 : 1], std::clamp(light, 160.0, 250.0), 3) << row << ' ' << col;
            EXPECT_EQ(colour[col < 5 ? 1 : 0], 0) << row << ' ' << col;
        }
    // Across the seam each pixel is of one chart or the other, as light as its neighbours.
    for (int x = 0; x < picture.width - 8; ++x) {
        const auto colour = pixel(picture, x, picture.height / 2);
        EXPECT_GT(std::max(colour[0], colour[1]), 190) << x;
    }
    EXPECT_TRUE(grid.texture_coordinates.back().hasNaN());
    for (std::size_t v = 0; v + 1 < grid.size(); ++v)
        EXPECT_TRUE((grid.texture_coordinates[v].array() > 0).all() && (grid.texture_coordinates[v].array() < 1).all());
}

TEST(BakedTexture, keeps_several_images_apart_and_leaves_out_what_has_none) {
    auto charts = crossed_charts();
    charts.images = {"a.png", "b.png"};
    charts.image_of_face = {1, 0};
    for (auto& uv : charts.positions) uv += TextureCoordinate(-3, 7);  // images repeat
    const io::Image red{1, 1, {255, 0, 0}}, blue{1, 1, {0, 0, 255}};
    auto grid = flat_grid();
    std::vector<std::optional<io::Image>> images = {red, blue};
    auto picture = bake_texture(charts, images, grid);
    EXPECT_EQ(at_vertex(picture, grid, 4, 2), (Rgb{0, 0, 255}));
    EXPECT_EQ(at_vertex(picture, grid, 4, 7), (Rgb{255, 0, 0}));
    images[1].reset();
    picture = bake_texture(charts, images, grid);
    EXPECT_EQ(at_vertex(picture, grid, 4, 2), (Rgb{204, 158, 135}));
    EXPECT_EQ(at_vertex(picture, grid, 4, 7), (Rgb{255, 0, 0}));
}

TEST(BakedTexture, repeats_an_image_that_the_scan_repeats) {
    auto charts = crossed_charts();
    // u runs from 0.5 to 3.5 over the first face: three copies of an image whose left half is red.
    charts.positions = {{0.5, 0}, {3.5, 0}, {3.5, 1}, {0.5, 1}, {0, 0}, {0, 0}, {0, 1}, {0, 1}};
    io::Image image{100, 1, {}};
    for (int col = 0; col < 100; ++col)
        for (const int channel : {0, 1, 2}) image.rgb.push_back(channel == (col < 50 ? 0 : 2) ? 255 : 0);
    auto grid = flat_grid();
    const std::vector<std::optional<io::Image>> images = {image};
    const auto picture = bake_texture(charts, images, grid);
    for (int col = 0; col < 5; ++col) {
        const double u = 0.5 + 3 * col / 4.5;
        EXPECT_EQ(at_vertex(picture, grid, 5, col)[u - std::floor(u) < 0.5 ? 0 : 2], 255) << col;
    }
}

TEST(BakedTexture, stands_positions_that_no_atlas_has) {
    auto charts = crossed_charts();
    charts.positions[0] = {1e300, 0};
    charts.positions[4] = {5000, -5000};
    auto grid = flat_grid();
    const std::vector<std::optional<io::Image>> images = {crossed_image()};
    EXPECT_EQ(bake_texture(charts, images, grid).height, 80);
}

}  // namespace
}  // namespace mimik::preprocessing
