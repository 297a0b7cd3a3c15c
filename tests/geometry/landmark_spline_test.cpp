#include "geometry/landmark_spline.h"

#include <gtest/gtest.h>

#include "tests/support/analytic_face.h"

namespace mimik::geometry {
namespace {

TEST(LandmarkSpline, takes_every_landmark_to_its_partner) {
    const auto source = test::AnalyticFace{}.landmarks(), target = test::AnalyticFace{1.1, 4.0}.landmarks();
    const auto spline = landmark_spline(source, target);
    for (const auto& mark : source.all())
        // Rounding of a 26 x 26 solve on coordinates of some ten millimetres.
        EXPECT_LT((spline(mark.position_mm) - target.position_mm(mark.name)).norm(), 1e-9) << mark.name;
}

TEST(LandmarkSpline, two_landmarks_on_one_point_count_as_one_with_their_mean_target) {
    const auto target = test::AnalyticFace{}.landmarks();
    std::vector<Landmark> marks(target.all().begin(), target.all().end());
    for (auto& mark : marks)
        if (mark.name == "lower_lip_inner") mark.position_mm = target.position_mm("upper_lip_inner");
    const auto spline = landmark_spline(Landmarks(marks), target);
    const Point middle = 0.5 * (target.position_mm("upper_lip_inner") + target.position_mm("lower_lip_inner"));
    EXPECT_EQ(spline.size(), 21U);
    EXPECT_LT((spline(target.position_mm("upper_lip_inner")) - middle).norm(), 1e-9);
}

}  // namespace
}  // namespace mimik::geometry
