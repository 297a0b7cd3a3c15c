#include "geometry/landmark_spline.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/analytic_face.h"
#include "tests/support/thrown.h"

namespace mimik::geometry {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(LandmarkPairs, landmarks_that_lie_on_one_another_are_merged_by_name_and_the_spline_still_passes_through_the_rest) {
    const auto marks = test::AnalyticFace{}.landmarks();
    std::vector<Landmark> closed(marks.all().begin(), marks.all().end());
    for (auto& mark : closed)
        if (mark.name == "lower_lip_inner") mark.position_mm = marks.position_mm("upper_lip_inner");
    const Landmarks from(closed);
    const auto to = test::AnalyticFace{1.2, 5}.landmarks();
    const LandmarkPairs pairs(from, to);
    EXPECT_THAT(pairs.merged(), ElementsAre("'lower_lip_inner' lies on 'upper_lip_inner'"));
    const auto spline = landmark_spline(from, to);
    for (const auto& mark : from.all())
        if (mark.name != "lower_lip_inner") {
            // Rounding of a dense solve of 25 equations on coordinates of a hundred millimetres.
            EXPECT_LT((spline(mark.position_mm) - to.position_mm(mark.name)).norm(), 1e-9) << mark.name;
        }
}

TEST(LandmarkPairs, landmarks_without_a_partner_are_named_on_the_side_that_has_them) {
    const Landmarks from({{"a", {0, 0, 0}, ""}, {"b", {9, 0, 0}, ""}}),
        to({{"b", {9, 0, 0}, ""}, {"c", {0, 9, 0}, ""}});
    const LandmarkPairs pairs(from, to);
    EXPECT_THAT(pairs.names(), ElementsAre("b"));
    EXPECT_THAT(pairs.only_in_from(), ElementsAre("a"));
    EXPECT_THAT(pairs.only_in_to(), ElementsAre("c"));
    EXPECT_THAT(message_of<InputError>([&] { pairs.require_partners(); }), HasSubstr("without a partner"));
    EXPECT_NO_THROW(LandmarkPairs(from, from).require_partners());
}

TEST(LandmarkPairs, what_is_apart_in_millimetres_is_apart_in_metres_too) {
    const auto marks = test::AnalyticFace{}.landmarks();
    const auto metres = transformed(marks, Transform(Eigen::Scaling(1e-3)));
    EXPECT_EQ(LandmarkPairs(marks, marks).size(), marks.size());
    EXPECT_EQ(LandmarkPairs(metres, metres).size(), marks.size());
}

}  // namespace
}  // namespace mimik::geometry
