#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"
#include "tests/support/lidded_face.h"

// [sample]
#include "animation/lid_field.h"

using namespace mimik;

/// A face whose left eye is closed, and what is to be said of it; the rest is as it was.
std::vector<geometry::Point> winking(const geometry::FaceSurface& face, const preprocessing::AverageFace& average,
                                     std::vector<std::string>& remarks) {
    const animation::PreparedTarget target(face, average);
    const auto wink = facs::Expression::of_units({{.unit = 46, .side = facs::Side::left}});
    auto field = geometry::DisplacementField::still(face.size());  // or that of a model, which the lids join
    animation::slide_lids(target, wink, field, &remarks);
    auto vertices_mm = face.vertices_mm;
    for (std::size_t v = 0; v < face.size(); ++v) vertices_mm[v] += field.mm[v];
    return vertices_mm;
}
// [end]

TEST(Samples, a_wink_moves_the_upper_lid_down_by_more_than_half_of_the_opening) {
    const auto face = test::LiddedFace{}.surface();
    std::vector<std::string> remarks;
    const auto moved = winking(face, test::analytic_average(), remarks);
    double lowest_mm = 0;
    for (std::size_t v = 0; v < face.size(); ++v)
        lowest_mm = std::min(lowest_mm, moved[v].y() - face.vertices_mm[v].y());
    EXPECT_LT(lowest_mm, -5.0);
    EXPECT_TRUE(remarks.empty());
}
