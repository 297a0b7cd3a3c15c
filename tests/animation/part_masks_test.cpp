#include "animation/part_masks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using test::message_of;
using testing::HasSubstr;

/// A sheet round a head, cut along y = 0: the upper half has the share 1, the lower one -1.
struct Sheet {
    preprocessing::FaceTemplate face_template;
    std::vector<PartShares> shares;
    Sheet() {
        const auto row = [&](double y, float share) {
            for (int k = 0; k <= 20; ++k) {
                const double angle = (k - 10) * 0.12;
                face_template.surface.vertices_mm.emplace_back(80 * std::sin(angle), y, 80 * std::cos(angle));
                shares.push_back({share, 0, 0});
            }
        };
        row(-30, -1), row(0, -1), row(0, 1), row(30, 1);
        for (const std::uint32_t first : {0U, 42U})
            for (std::uint32_t k = 0; k < 20; ++k) {
                const std::uint32_t a = first + k;
                face_template.surface.triangles.push_back({a, a + 1, a + 22});
                face_template.surface.triangles.push_back({a, a + 22, a + 21});
            }
    }
};

TEST(PartTexture, says_of_a_point_on_which_side_of_the_cut_it_lies) {
    const Sheet sheet;
    const PartTexture texture(sheet.face_template, sheet.shares, sheet.face_template.surface.vertices_mm, {720, 600});
    // Rows are 0.1 mm high: what is further from the cut than that is told apart.
    for (const double angle : {-0.9, -0.3, 0.0, 0.5, 1.1})
        for (const double y : {0.15, 2.0, 25.0}) {
            const Point above(80 * std::sin(angle), y, 80 * std::cos(angle));
            EXPECT_EQ(texture.at(above).mouth, 1);
            EXPECT_EQ(texture.at(Point(above.x(), -y, above.z())).mouth, -1);
        }
    EXPECT_EQ(texture.at(Point(0, 40, 80)).mouth, 0) << "above the template";
    EXPECT_EQ(texture.at(Point(0, 5, -200)).mouth, 0) << "behind the head";
}

TEST(PartTexture, is_warped_as_the_template_is_bent) {
    const Sheet sheet;
    auto bent = sheet.face_template.surface.vertices_mm;
    for (auto& p : bent) p.y() = p.y() + 0.1 * p.x() + 7;  // a mouth that stands askew and higher
    const PartTexture texture(sheet.face_template, sheet.shares, bent, {720, 720});
    for (const double angle : {-0.6, 0.0, 0.6}) {
        const double x = 80 * std::sin(angle), z = 80 * std::cos(angle), line = 0.1 * x + 7;
        EXPECT_EQ(texture.at(Point(x, line + 1, z)).mouth, 1);
        EXPECT_EQ(texture.at(Point(x, line - 1, z)).mouth, -1);
    }
}

TEST(PartTexture, what_lies_between_lips_that_stand_apart_belongs_to_the_nearer_one) {
    const Sheet sheet;
    auto bent = sheet.face_template.surface.vertices_mm;
    for (std::size_t v = 42; v < bent.size(); ++v) bent[v].y() += 4;  // the upper half; a gap from 0 to 4 mm
    const PartTexture texture(sheet.face_template, sheet.shares, bent, {720, 640});
    EXPECT_EQ(texture.at(Point(0, 3, 80)).mouth, 1);
    EXPECT_EQ(texture.at(Point(0, 1, 80)).mouth, -1);
}

TEST(PartTexture, bad_sizes_are_refused) {
    const Sheet sheet;
    EXPECT_THAT(message_of([&] {
                    PartTexture(sheet.face_template, sheet.shares, sheet.face_template.surface.vertices_mm, {1, 600});
                }),
                HasSubstr("columns is 1"));
}

}  // namespace
}  // namespace mimik::animation
