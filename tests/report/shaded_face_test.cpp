#include "report/shaded_face.h"

#include <algorithm>
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::report {
namespace {

/// Two squares of 10 mm, one 5 mm before the other's right half, each in its colour.
geometry::Mesh squares() {
    geometry::Mesh mesh;
    mesh.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {5, 0, 5}, {10, 0, 5}, {10, 10, 5}, {5, 10, 5}};
    mesh.faces.add(std::vector<std::uint32_t>{4, 5, 6, 7});
    mesh.faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    mesh.colours.assign(8, {200, 0, 0});
    std::fill(mesh.colours.begin() + 4, mesh.colours.end(), std::array<std::uint8_t, 3>{0, 200, 0});
    return mesh;
}

std::array<int, 3> at(const io::Image& image, int col, int row) {
    const auto k = 3 * static_cast<std::size_t>(row * image.width + col);
    return {image.rgb[k], image.rgb[k + 1], image.rgb[k + 2]};
}

TEST(ShadedFace, what_is_nearer_hides_what_is_behind_and_the_margin_is_background) {
    ShadedFaceOptions options;
    options.width = options.height = 100;
    options.margin = 0.1;  // 10 pixels; 8 pixels a millimetre
    const auto mesh = squares();
    const FacePainter painter(mesh, {}, options);
    const auto image = painter.picture(mesh.vertices_mm);
    EXPECT_EQ(at(image, 4, 50), (std::array<int, 3>{246, 246, 246}));
    const auto left = at(image, 25, 50), right = at(image, 75, 50);
    EXPECT_GT(left[0], 100);
    EXPECT_EQ(left[1], 0);
    EXPECT_EQ(right[0], 0);
    EXPECT_GT(right[1], 100);
}

TEST(ShadedFace, the_view_stays_where_the_face_at_rest_put_it) {
    ShadedFaceOptions options;
    options.width = options.height = 100;
    options.margin = 0.1;
    const auto mesh = squares();
    const FacePainter painter(mesh, {}, options);
    auto moved = mesh.vertices_mm;
    for (auto& p : moved) p.y() += 2;  // 16 pixels up
    const auto image = painter.picture(moved);
    EXPECT_EQ(at(image, 25, 85), (std::array<int, 3>{246, 246, 246}));
    EXPECT_GT(at(image, 25, 60)[0], 100);
}

TEST(ShadedFace, a_texture_is_the_right_way_up) {
    auto mesh = squares();
    mesh.colours.clear();
    // u to the right, v up, over the square behind; the square before it has the picture's middle.
    mesh.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}};
    const io::Image texture{1, 2, {200, 0, 0, 0, 0, 200}};  // red above, blue below
    ShadedFaceOptions options;
    options.width = options.height = 100;
    const auto image = FacePainter(mesh, texture, options).picture(mesh.vertices_mm);
    EXPECT_GT(at(image, 25, 25)[0], 100);
    EXPECT_GT(at(image, 25, 75)[2], 100);
}

TEST(ShadedFace, a_mesh_without_faces_is_refused) {
    geometry::Mesh cloud;
    cloud.vertices_mm = {{0, 0, 0}};
    EXPECT_THAT(test::message_of([&] { FacePainter{cloud}; }), testing::HasSubstr("has no surface"));
}

}  // namespace
}  // namespace mimik::report
