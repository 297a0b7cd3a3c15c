#include "evaluation/lip_aperture.h"

#include <gtest/gtest.h>

#include "tests/support/flat_face.h"

namespace mimik::evaluation {
namespace {

using geometry::Landmarks;
using geometry::Vector;
using test::FlatFace;

/// Rounding of sums of numbers below 10.
constexpr double rounding_mm = 1e-12;

/// The lower lip goes down by 7 mm and the upper one holds still: the real lips are 7 mm farther apart than at rest.
struct OpenedLips {
    explicit OpenedLips(double gap_mm)
        : neutral(geometry::face_surface(FlatFace::grid(), FlatFace::landmarks(gap_mm))),
          target(FlatFace::target(neutral, FlatFace::grid())) {
        auto marks = std::vector<geometry::Landmark>(neutral.landmarks.all().begin(), neutral.landmarks.all().end());
        for (auto& mark : marks)
            if (mark.name.starts_with("lower_lip")) mark.position_mm.y() -= 7;
        target.expressive_landmarks = Landmarks(marks);
    }
    [[nodiscard]] std::optional<LipAperture> of(const geometry::DisplacementField& field) const {
        return lip_aperture({target, neutral, field});
    }
    geometry::FaceSurface neutral;
    ScoredTarget target;
};

geometry::DisplacementField parted() {
    return FlatFace::field([](double, double y) { return y < 0 ? Vector(0, -7, 0) : Vector(0, 0, 0); });
}

TEST(LipAperture, of_a_field_that_opens_the_lips_by_7_mm_is_the_neutral_gap_and_7_mm) {
    for (const double gap_mm : {0.0, 1.2}) {
        const auto found = OpenedLips(gap_mm).of(parted()).value();
        EXPECT_NEAR(found.animated_mm, gap_mm + 7, rounding_mm);
        EXPECT_NEAR(found.real_mm, gap_mm + 7, rounding_mm);
    }
}

TEST(LipAperture, of_doing_nothing_and_of_moving_both_lips_alike_is_the_neutral_gap) {
    const OpenedLips lips(1.2);
    EXPECT_NEAR(lips.of(geometry::DisplacementField::still(lips.neutral.size()))->animated_mm, 1.2, rounding_mm);
    EXPECT_NEAR(lips.of(FlatFace::field([](double, double) { return Vector(3, -7, 2); }))->animated_mm, 1.2,
                rounding_mm);
}

TEST(LipAperture, of_a_sewn_mouth_is_what_the_web_stretches_between_the_two_lips_alone) {
    // The web falls evenly from 8 mm above the line of the lips to 8 mm below: by 7 / 16 mm per mm. The landmarks'
    // skin is that of y = 3 and y = -3 (2 mm from 0.6 mm).
    const OpenedLips lips(1.2);
    const auto sewn = FlatFace::field([](double, double y) {
        return Vector(0, y > 8 ? 0.0 : y < -8 ? -7.0 : -7 * (8 - y) / 16, 0);
    });
    const auto estimator = lip_aperture_estimator();
    const JudgedFace face{lips.target, lips.neutral, sewn};
    EXPECT_NEAR(test::measured(*estimator, face, "mouth", "animated").value(), 1.2 + 6 * 7.0 / 16, rounding_mm);
    EXPECT_NEAR(test::measured(*estimator, face, "mouth", "real").value(), 8.2, rounding_mm);
    EXPECT_NEAR(test::measured(*estimator, face, "mouth", "error").value(), 6 * 7.0 / 16 - 7, rounding_mm);
}

TEST(LipAperture, is_not_told_by_skin_between_the_lips_that_is_nearest_to_both) {
    // 2 mm on either side of the line nothing was measured: what is nearest stands on the line itself.
    OpenedLips lips(0.0);
    for (int y = -3; y <= 3; ++y)
        for (int x = -10; x <= 10; ++x) lips.neutral.measured[FlatFace::vertex(x, y)] = y == 0 ? 1 : 0;
    EXPECT_NEAR(lips.of(parted())->animated_mm, 7, rounding_mm);  // by the skin at y = 4 and -4
    for (int y = -5; y <= 5; ++y)
        for (int x = -10; x <= 10; ++x) lips.neutral.measured[FlatFace::vertex(x, y)] = y == 0 ? 1 : 0;
    EXPECT_FALSE(lips.of(parted()));
}

TEST(LipAperture, is_told_along_the_axis_of_the_face_however_it_is_turned) {
    OpenedLips lips(1.2);
    const geometry::Transform turned(Eigen::AngleAxisd(0.7, Vector(1, 2, 3).normalized()));
    for (auto& p : lips.neutral.vertices_mm) p = turned * p;
    lips.neutral.landmarks = geometry::transformed(lips.neutral.landmarks, turned);
    lips.target.expressive_landmarks = geometry::transformed(lips.target.expressive_landmarks, turned);
    auto field = parted();
    for (auto& way : field.mm) way = turned.linear() * way;
    EXPECT_NEAR(lips.of(field)->animated_mm, 8.2, rounding_mm);
    EXPECT_NEAR(lips.of(field)->real_mm, 8.2, rounding_mm);
}

TEST(LipAperture, is_unknown_without_a_landmark_in_either_scan_or_without_skin_at_the_lips) {
    const auto without = [](const Landmarks& all, const std::string& name) {
        std::vector<geometry::Landmark> kept;
        for (const auto& mark : all.all())
            if (mark.name != name) kept.push_back(mark);
        return Landmarks(kept);
    };
    for (const auto* name : {"upper_lip_inner", "lower_lip_inner", "lower_lip_outer", "nose_tip"}) {
        OpenedLips lips(1.2);
        lips.neutral.landmarks = without(lips.neutral.landmarks, name);
        EXPECT_FALSE(lips.of(parted())) << name;
    }
    OpenedLips unmarked(1.2), unmeasured(1.2);
    unmarked.target.expressive_landmarks = without(unmarked.target.expressive_landmarks, "lower_lip_inner");
    for (int y = -10; y <= 10; ++y)
        for (int x = -10; x <= 10; ++x) unmeasured.neutral.measured[FlatFace::vertex(x, y)] = 0;
    for (const auto* lips : {&unmarked, &unmeasured}) {
        EXPECT_FALSE(lips->of(parted()));
        EXPECT_TRUE(lip_aperture_estimator()->measure({lips->target, lips->neutral, parted()}).empty());
    }
}

}  // namespace
}  // namespace mimik::evaluation
