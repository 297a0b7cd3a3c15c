#include "preprocessing/lid_margins.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/lidded_face.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using test::LiddedFace;

LidMargins found_on(const geometry::FaceSurface& face, const LidMarginOptions& options = {}) {
    return find_lid_margins(face.vertices_mm, face.triangles, face.measured, face.landmarks, options);
}

/// The largest distance, seen from the front, of margins of an eye from where they are known to be.
double largest_error_mm(const EyeLids& eye) {
    double largest = 0;
    for (const auto& s : eye.sections) {
        const auto at = [&](double rad, double rho) -> Point {
            return eye.centre_mm + eye.axes.transpose() * Point(s.x_mm, rho * std::sin(rad), rho * std::cos(rad));
        };
        const Point upper = at(s.upper_rad, s.upper_rho_mm), lower = at(s.lower_rad, s.lower_rho_mm);
        // The corners are rounded off by smoothing, and their place is a landmark's matter.
        if (std::abs(std::abs(upper.x()) - LiddedFace::middle_x) > 0.8 * LiddedFace::half_width_mm) continue;
        largest = std::max({largest, std::abs(upper.y() - LiddedFace::margins_y(upper.x())[1]),
                            std::abs(lower.y() - LiddedFace::margins_y(lower.x())[0])});
    }
    return largest;
}

class LidMarginsOf : public testing::TestWithParam<LiddedFace::Eyes> {};

TEST_P(LidMarginsOf, an_eye_are_found_within_a_step_of_the_lattice) {
    const auto margins = found_on(LiddedFace{GetParam()}.surface());
    for (const auto side : {facs::Side::left, facs::Side::right}) {
        const auto& eye = margins.of(side);
        ASSERT_TRUE(eye.found) << eye.reason;
        EXPECT_GT(eye.confidence, 0.7);
        // Faces that the opening cuts are left out whole, and the rest of a step is its diagonal.
        EXPECT_LT(largest_error_mm(eye), 1.5 * LiddedFace::step_mm);
        EXPECT_GT(eye.sections.size(), 30U);
    }
}

TEST_P(LidMarginsOf, an_eye_know_its_eyeball) {
    const auto kind = GetParam();
    const auto margins = found_on(LiddedFace{kind}.surface());
    const auto& eye = margins.left;
    EXPECT_EQ(eye.eyeball, kind == LiddedFace::Eyes::hole   ? EyeballKind::none
                           : kind == LiddedFace::Eyes::ball ? EyeballKind::part
                                                            : EyeballKind::surface);
    // Of a hole it is guessed from the margins, which stand 1 mm off it, and held near the usual size.
    const double within_mm = kind == LiddedFace::Eyes::hole ? 3.5 : 0.3;
    EXPECT_NEAR(eye.radius_mm, LiddedFace::radius_mm, within_mm);
    EXPECT_LT((eye.centre_mm - LiddedFace::centre()).norm(), within_mm);
    const auto of_balls = std::count(margins.eyeball.begin(), margins.eyeball.end(), 1);
    EXPECT_EQ(of_balls, kind == LiddedFace::Eyes::ball ? 2 * 24 * 11 : 0);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, LidMarginsOf,
                         testing::Values(LiddedFace::Eyes::hole, LiddedFace::Eyes::ball, LiddedFace::Eyes::surface));

TEST(LidMargins, a_face_without_eyes_says_so) {
    const auto margins = found_on(LiddedFace{LiddedFace::Eyes::none}.surface());
    for (const auto* eye : {&margins.left, &margins.right}) {
        EXPECT_FALSE(eye->found);
        EXPECT_NE(eye->reason.find("no opening"), std::string::npos) << eye->reason;
        EXPECT_EQ(eye->confidence, 0.0);
    }
}

TEST(LidMargins, a_missing_landmark_is_the_reason_for_its_eye_alone) {
    auto face = LiddedFace{}.surface();
    std::vector<geometry::Landmark> marks;
    for (const auto& mark : face.landmarks.all())
        if (mark.name != "eye_outer_right") marks.push_back(mark);
    face.landmarks = geometry::Landmarks(std::move(marks));
    const auto margins = found_on(face);
    EXPECT_TRUE(margins.left.found);
    EXPECT_FALSE(margins.right.found);
    EXPECT_NE(margins.right.reason.find("landmark"), std::string::npos);
}

TEST(LidMargins, options_out_of_range_are_refused) {
    EXPECT_THROW((void)found_on(LiddedFace{}.surface(), {.columns = 1}), InputError);
    EXPECT_THROW((void)found_on(LiddedFace{}.surface(), {.usual_radius = 0}), InputError);
}

}  // namespace
}  // namespace mimik::preprocessing
