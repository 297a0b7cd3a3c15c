#include <gtest/gtest.h>

#include "tests/support/slit_sheet.h"

// [sample]
#include "geometry/expression_cloning.h"

using namespace mimik;

/// Where the vertices of a target go when it does what a source did. Both have the same triangles.
std::vector<geometry::Point> does_as(std::span<const geometry::Point> source_mm,
                                     std::span<const geometry::Vector> motion_mm,
                                     std::span<const geometry::Point> target_mm,
                                     std::span<const geometry::Triangle> triangles) {
    const auto cloned = geometry::cloned_motion(source_mm, motion_mm, target_mm, triangles);
    std::vector<geometry::Point> moved;
    for (std::size_t v = 0; v < target_mm.size(); ++v) moved.push_back(target_mm[v] + cloned[v]);
    return moved;
}
// [end]

TEST(Samples, a_face_does_as_itself) {
    const test::SlitSheet sheet;
    const auto motion = sheet.parting_mm();
    const auto moved = does_as(sheet.rest_mm, motion, sheet.rest_mm, sheet.triangles);
    for (std::size_t v = 0; v < moved.size(); ++v)
        EXPECT_LT((moved[v] - sheet.rest_mm[v] - motion[v]).norm(), 1e-9);  // rounding
}
