#include "evaluation/peak.h"

#include <gtest/gtest.h>

#include "tests/support/flat_face.h"

namespace mimik::evaluation {
namespace {

using geometry::Vector;
using test::FlatFace;

TEST(Peak, is_the_motion_of_the_zone_that_a_few_spikes_and_what_lies_outside_do_not_raise) {
    const auto neutral = geometry::face_surface(FlatFace::grid(), FlatFace::landmarks());
    auto target = FlatFace::target(neutral, FlatFace::grid());
    // 24 of the zone's 61 x 41 vertices are spikes: fewer than 1 %.
    const auto field = FlatFace::field([](double x, double y) {
        const bool in_zone = std::abs(x) <= 30 && std::abs(y) <= 20;
        return Vector(0, 0, !in_zone ? 20 : y == 5 && x > 0 && x < 25 ? 50 : 3);
    });
    EXPECT_EQ(test::measured(*peak_estimator(), {target, neutral, field}, "zone", "animated"), 3);
    EXPECT_EQ(test::measured(*peak_estimator(), {target, neutral, field}, "zone", "true"), std::nullopt);
    target.true_displacement_mm.assign(target.vertices.size(), Vector(0, 4, 0));
    EXPECT_EQ(test::measured(*peak_estimator(), {target, neutral, field}, "zone", "true"), 4);
    const auto still = geometry::DisplacementField::still(neutral.size());
    EXPECT_EQ(test::measured(*peak_estimator(), {target, neutral, still}, "zone", "animated"), 0);
}

TEST(Peak, of_lengths_that_rise_evenly_is_where_99_in_100_stay_below) {
    const auto neutral = geometry::face_surface(FlatFace::grid(), FlatFace::landmarks());
    const auto target = FlatFace::target(neutral, FlatFace::grid());
    // The zone's 61 columns move by 0 ... 60 mm: 99 % of them lie below the last one, as 60 / 61 < 0.99.
    const auto field = FlatFace::field([](double x, double) { return Vector(0, 0, x + 30); });
    EXPECT_EQ(test::measured(*peak_estimator(), {target, neutral, field}, "zone", "animated"), 60);
}

}  // namespace
}  // namespace mimik::evaluation
