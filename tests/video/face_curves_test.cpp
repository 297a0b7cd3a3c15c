#include "video/face_curves.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "synthesis/face_model.h"
#include "video/builtin_feature_lines.h"

namespace mimik::video {
namespace {

BezierCurve some_curve() { return {{Pixel(10, 20), Pixel(20, 5), Pixel(45, 0), Pixel(60, 25)}}; }

TEST(FaceCurves, a_curve_is_recovered_from_its_own_points) {
    const auto curve = some_curve();
    std::vector<Pixel> points;
    for (int k = 0; k <= 400; ++k) points.push_back(curve.at(k / 400.0));
    const auto fit = fit_curve(points);
    // Parameters are shares of the length and not the curve's own, so the control points differ a little, not the line.
    for (int k = 0; k <= 20; ++k) EXPECT_LT(distance_px(fit, curve.at(k / 20.0)), 0.5);
    EXPECT_LT((fit.control[0] - curve.control[0]).norm(), 1e-12);
    EXPECT_LT((fit.control[3] - curve.control[3]).norm(), 1e-12);
}

TEST(FaceCurves, one_point_is_no_curve) {
    const std::vector<Pixel> one = {Pixel(1, 2)};
    EXPECT_THROW((void)fit_curve(one), InputError);
}

TEST(FaceCurves, points_of_curves_through_points_are_those_points) {
    Points68 points;
    points.fill(Pixel::Zero());
    FaceCurves curves = mean_face_curves();
    for (auto& curve : curves.curve)
        for (auto& p : curve.control) p = 100 * p + Pixel(200, 150);
    points_on_curves(curves, points);
    Points68 again = points;
    points_on_curves(curves_through(points), again);
    // Four control points do not pass through all seven points of a lip: 3 % of the eyes' distance is what is lost.
    for (const auto& place : places_on_curves())
        EXPECT_LT((again[static_cast<std::size_t>(place.point)] - points[static_cast<std::size_t>(place.point)]).norm(),
                  3.0)
            << place.point;
}

TEST(FaceCurves, the_mean_face_is_that_of_the_built_in_model) {
    const auto model = synthesis::make_builtin_face_model();
    auto mean = model->neutral_mm(model->draw_identity(0, synthesis::Sex::female, 0));
    const auto other = model->neutral_mm(model->draw_identity(0, synthesis::Sex::male, 0));
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = 0.5 * (mean[k] + other[k]);
    const auto& marks = model->landmark_vertices();
    const geometry::Point left = mean[marks.at("eye_outer_left")], right = mean[marks.at("eye_outer_right")];
    const geometry::Point middle = 0.5 * (left + right);
    EXPECT_NEAR(mean_face_outer_eyes_mm(), (left - right).norm(), 1e-3);  // as many digits stand in the table
    const auto lines = builtin_feature_lines();
    for (std::size_t p = 17; p < 68; ++p) {
        if (p == 18 || (p >= 17 && p <= 26)) continue;
        EXPECT_LT((mean_face_points68_mm()[p] - (mean[lines.points[p]] - middle)).norm(), 0.02) << p;
    }
}

}  // namespace
}  // namespace mimik::video
