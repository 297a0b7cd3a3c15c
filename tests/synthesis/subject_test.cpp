#include "synthesis/subject.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/synthesis/dome_model.h"

namespace mimik::synthesis {
namespace {

VarianceOptions none() {
    VarianceOptions options;
    options.identity = options.amplitude_person = options.amplitude_performance = options.shape = 0;
    options.asymmetry_person = options.asymmetry_performance = options.co_activation = options.co_activation_spread = 0;
    options.size_coupling = options.field_magnitude = options.field_direction_deg = options.micro_expression = 0;
    return options;
}

TEST(Perform, without_any_variance_is_the_weighted_shape) {
    const auto model = make_dome_model();
    const auto subject = draw_subject(*model, "bs000", 1, none());
    const auto smile = perform(subject, make_expression("12"), "bs000_LFAU_12_0", 1, none());
    const auto left = model->shape_displacement_mm(subject.identity, "mouthSmile_L");
    const auto right = model->shape_displacement_mm(subject.identity, "mouthSmile_R");
    for (std::size_t i = 0; i < left.size(); ++i)
        ASSERT_LT((smile.displacement_mm[i] - 0.70 * (left[i] + right[i])).norm(), 1e-12);  // rounding
    EXPECT_EQ(perform(subject, make_expression("N"), "bs000_N_N_0", 1, none()).vertices_mm, subject.resting_mm);
}

TEST(Perform, one_nuisance_leaves_the_draws_of_the_others_alone) {
    const auto model = make_dome_model();
    auto options = none();
    options.amplitude_performance = 0.15;
    const auto subject = draw_subject(*model, "bs000", 1, options);
    const double alone = perform(subject, make_expression("12"), "bs000_LFAU_12_0", 1, options).amplitude;
    options.shape = 0.05;
    options.micro_expression = 0.015;
    options.asymmetry_performance = 0.06;
    EXPECT_EQ(perform(subject, make_expression("12"), "bs000_LFAU_12_0", 1, options).amplitude, alone);
    EXPECT_NE(perform(subject, make_expression("12"), "bs000_LFAU_12_1", 1, options).amplitude, alone);
}

TEST(Perform, smooth_field_turns_and_stretches_as_asked) {
    const auto model = make_dome_model();
    auto options = none();
    options.field_magnitude = 0.15;
    options.field_direction_deg = 7.0;
    const auto plain = none();
    const auto subject = draw_subject(*model, "bs000", 1, plain);
    double turn2 = 0, stretch2 = 0;
    constexpr int draws = 400;
    const auto still = perform(subject, make_expression("12"), "x", 1, plain);
    const auto corner = model->landmark_vertices().at("mouth_corner_left");
    for (int k = 0; k < draws; ++k) {
        const auto moved = perform(subject, make_expression("12"), "x", static_cast<std::uint64_t>(k), options);
        const auto &a = still.displacement_mm[corner], &b = moved.displacement_mm[corner];
        const double angle = std::acos(std::min(1.0, a.dot(b) / (a.norm() * b.norm()))) * 180.0 / 3.14159265358979;
        turn2 += angle * angle;
        stretch2 += std::pow(b.norm() / a.norm() - 1.0, 2);
    }
    EXPECT_NEAR(std::sqrt(turn2 / draws), 7.0, 0.8);        // three standard errors of an rms over 400 draws
    EXPECT_NEAR(std::sqrt(stretch2 / draws), 0.15, 0.018);  // the same
}

TEST(VarianceOptions, a_value_out_of_range_is_named) {
    VarianceOptions options;
    options.field_length_mm = 0;
    try {
        options.check();
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("field_length_mm is 0"));
    }
}

}  // namespace
}  // namespace mimik::synthesis
