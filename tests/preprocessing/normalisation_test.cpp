#include "preprocessing/normalisation.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "preprocessing/preprocess_run.h"
#include "preprocessing/template_registration.h"
#include "tests/support/analytic_face.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::Transform;
using test::AnalyticFace;
using testing::HasSubstr;

Transform turned(double angle_rad, const Point& shift, double scale = 1.0) {
    return Transform(Eigen::Translation3d(shift) * Eigen::AngleAxisd(angle_rad, Point(0.3, 1, 0.2).normalized()) *
                     Eigen::Scaling(scale));
}

TEST(AffineNormalisation, takes_its_four_landmarks_exactly_to_those_of_the_average_face) {
    const auto scan = geometry::transformed(AnalyticFace{1.1, 3.0}.landmarks(), turned(0.2, {40, -10, 700}));
    const auto average = AnalyticFace{}.landmarks();
    const Transform average_from_scan = affine_normalisation(scan, average);
    for (const auto name : affine_landmarks)
        // Rounding of a 4 x 4 solve on coordinates of some hundred millimetres.
        EXPECT_LT((average_from_scan * scan.position_mm(name) - average.position_mm(name)).norm(), 1e-9) << name;
}

TEST(AffineNormalisation, four_landmarks_in_one_plane_are_refused) {
    const geometry::Landmarks flat({{"eye_outer_left", {45, 35, 0}, ""},
                                    {"eye_outer_right", {-45, 35, 0}, ""},
                                    {"chin", {0, -60, 0}, ""},
                                    {"nose_tip", {0, 0, 0}, ""}});
    try {
        (void)affine_normalisation(flat, AnalyticFace{}.landmarks());
        FAIL() << "accepted";
    } catch (const NumericalError& e) {
        EXPECT_THAT(e.what(), HasSubstr("one plane"));
    }
}

TEST(AffineNormalisation, a_missing_chin_is_named) {
    const geometry::Landmarks some({{"eye_outer_left", {45, 35, 0}, ""}, {"nose_tip", {0, 0, 9}, ""}});
    try {
        (void)affine_normalisation(some, AnalyticFace{}.landmarks());
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("'eye_outer_right' is missing"));
    }
}

TEST(SimilarityNormalisation, recovers_a_known_turn_shift_and_scale) {
    const auto marks = AnalyticFace{}.landmarks();
    const Transform scan_from_average = turned(-0.4, {5, 60, -300}, 1.3);
    const Transform found = similarity_normalisation(geometry::transformed(marks, scan_from_average), marks);
    EXPECT_LT((found * scan_from_average * Point(30, -20, 10) - Point(30, -20, 10)).norm(), 1e-9);
    EXPECT_NEAR(std::cbrt(found.linear().determinant()), 1 / 1.3, 1e-12);
}

TEST(SimilarityNormalisation, keeps_the_expression_that_the_affine_one_takes_away) {
    // A chin that moves up by 8 mm, as in AU17: the affine map puts it back, exactly.
    const auto neutral = AnalyticFace{}.landmarks();
    std::vector<geometry::Landmark> marks(neutral.all().begin(), neutral.all().end());
    for (auto& mark : marks)
        if (mark.name == "chin") mark.position_mm.y() += 8;
    const geometry::Landmarks raised(marks);
    const Point chin = raised.position_mm("chin"), rest = neutral.position_mm("chin");
    EXPECT_LT((affine_normalisation(raised, neutral) * chin - rest).norm(), 1e-9);
    // One landmark of 22 moves the least-squares fit by about its 22nd part, a little more since it lies at the rim.
    EXPECT_GT((similarity_normalisation(raised, neutral) * chin - rest).norm(), 6.0);
}

TEST(SimilarityNormalisation, landmarks_on_one_line_are_refused) {
    const geometry::Landmarks line({{"a", {0, 0, 0}, ""}, {"b", {1, 0, 0}, ""}, {"c", {2, 0, 0}, ""}});
    EXPECT_THROW((void)similarity_normalisation(line, line), NumericalError);
}

}  // namespace
}  // namespace mimik::preprocessing
