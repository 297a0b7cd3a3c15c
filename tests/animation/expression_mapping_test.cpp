#include "animation/expression_mapping.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "animation/shape_performance.h"
#include "base/errors.h"
#include "tests/animation/performer.h"
#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using geometry::Vector;
using testing::HasSubstr;

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
    return x.dot(y) / (x.norm() * y.norm());
}

TEST(ExpressionMapping, at_an_example_its_weight_is_1_and_all_others_are_0) {
    const auto source = test::three_examples();
    const ExpressionMapping mapping(source);
    const std::vector<std::uint8_t> all(source.features.size(), 1);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto mapped = mapping.map(source.displacement_mm[i], all);
        for (std::size_t j = 0; j < 3; ++j)
            EXPECT_NEAR(mapped.weights[static_cast<Eigen::Index>(j)], i == j ? 1 : 0, 1e-9);
        EXPECT_LT(mapped.unexplained_rms_mm, 1e-9);
    }
}

TEST(ExpressionMapping, known_weights_come_back_through_noise_and_from_a_performer_of_another_size) {
    const auto source = test::three_examples();
    // Noise of 0.3 mm is what trackers have on a still face; weights move some millimetres.
    const auto motion = test::performed(source, 300, 0.3, 1.3);
    const auto rest = performer_rest(motion, 0, 14);
    double factor = 0;
    const ExpressionMapping mapping(fitted_examples(source, motion, rest, &factor));
    EXPECT_NEAR(factor, 1.3, 0.01);  // corners of eyes with noise, of which 15 frames take a quarter
    const auto mapped = map_performance(motion, rest, mapping);
    for (Eigen::Index i = 0; i < 3; ++i) {
        Eigen::VectorXd truth(300);
        for (Eigen::Index f = 0; f < 300; ++f)
            truth[f] = test::known_weight(static_cast<std::size_t>(i), static_cast<double>(f) / 30);
        EXPECT_GT(correlation(mapped.weights.col(i), truth), 0.98) << i;
    }
    EXPECT_EQ(mapped.lost, 0U);
}

TEST(ExpressionMapping, of_a_flat_motion_an_example_that_is_shown_exactly_has_weight_1) {
    auto source = test::three_examples();
    for (std::size_t i = 0; i < 3; ++i)  // depth of its own, that a motion of pixels cannot show
        for (std::size_t k = 0; k < source.features.size(); ++k)
            source.displacement_mm[i][k].z() += 2.0 * static_cast<double>((i + k) % 3);
    auto motion = test::performed(source, 60, 0.0);
    for (auto& frame : motion.frames)
        for (std::size_t k = 0; k < source.features.size(); ++k) frame.features[k].head_mm = source.neutral_mm[k];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < source.features.size(); ++k) {
            const auto& d = source.displacement_mm[i][k];
            motion.frames[50 + i].features[k].head_mm += Vector(d.x(), d.y(), 0);
        }
    const auto rest = performer_rest(motion, 0, 9);
    const auto mapped = map_performance(motion, rest, ExpressionMapping(fitted_examples(source, motion, rest)));
    for (Eigen::Index i = 0; i < 3; ++i)
        for (Eigen::Index j = 0; j < 3; ++j) EXPECT_NEAR(mapped.weights(50 + i, j), i == j ? 1 : 0, 1e-9);
}

TEST(ExpressionMapping, features_that_are_not_seen_are_done_without) {
    const auto source = test::three_examples();
    const ExpressionMapping mapping(source);
    std::vector<std::uint8_t> valid(source.features.size(), 1);
    auto moved = source.displacement_mm[0];
    moved[3] = Vector(99, 99, 99);  // what a lost feature says is not heard
    valid[3] = 0;
    // The left corner alone says how much of a smile there is, but for the ridge of a thousandth.
    EXPECT_NEAR(mapping.map(moved, valid).weights[0], 1, 0.02);
}

TEST(ExpressionMapping, clamping_takes_away_overshoot_and_gain_multiplies_what_is_left) {
    const auto source = test::three_examples();
    auto motion = test::performed(source, 60, 0.0);
    for (std::size_t k = 0; k < source.features.size(); ++k) {
        motion.frames[58].features[k].head_mm = source.neutral_mm[k] + 1.5 * source.displacement_mm[0][k];
        motion.frames[59].features[k].head_mm = source.neutral_mm[k] - 0.5 * source.displacement_mm[0][k];
    }
    const auto rest = performer_rest(motion, 0, 9);
    const auto plain = map_performance(motion, rest, ExpressionMapping(source));
    EXPECT_GE(plain.overshoots, 1U);
    EXPECT_GE(plain.negatives, 1U);
    EXPECT_GT(plain.weights(58, 0), 1.2);
    EXPECT_LT(plain.weights(59, 0), -0.2);
    ExpressionMappingOptions options;
    options.clamp = true;
    options.gain = 0.5;
    const auto clamped = map_performance(motion, rest, ExpressionMapping(source, options));
    EXPECT_EQ(clamped.weights(58, 0), 0.5);
    EXPECT_EQ(clamped.weights(59, 0), 0.0);
    EXPECT_EQ(clamped.largest_weight, plain.largest_weight) << "what is reported is before clamping";
}

TEST(ExpressionMapping, a_face_that_is_lost_is_held_and_then_goes_to_rest) {
    const auto source = test::three_examples();
    auto motion = test::performed(source, 120, 0.0);
    for (std::size_t f = 31; f < 120; ++f) {
        motion.frames[f].state = capture::TrackState::lost;
        for (auto& feature : motion.frames[f].features) feature.valid = false;
    }
    const auto mapped = map_performance(motion, performer_rest(motion, 0, 9), ExpressionMapping(source));
    EXPECT_EQ(mapped.lost, 89U);
    EXPECT_GT(mapped.weights(30, 0), 0.5);
    EXPECT_EQ(mapped.weights(35, 0), mapped.weights(30, 0));          // 0.17 s
    EXPECT_LT(mapped.weights(119, 0), 0.01 * mapped.weights(30, 0));  // 3 s: nine time constants
}

TEST(ExpressionMapping, key_frames_are_examples_of_the_performers_own) {
    const auto source = test::three_examples();
    auto motion = test::performed(source, 90, 0.0);
    for (std::size_t k = 0; k < source.features.size(); ++k) {
        motion.frames[80].features[k].head_mm = source.neutral_mm[k] + source.displacement_mm[1][k];
        motion.frames[81].features[k].head_mm = source.neutral_mm[k] + source.displacement_mm[0][k];
    }
    motion.frames[82].state = capture::TrackState::lost;
    for (auto& feature : motion.frames[82].features) feature.valid = false;
    const auto rest = performer_rest(motion, 0, 9);
    const std::vector<KeyFrame> keys = {{"open", 80}, {"smile", 81}};
    const auto own = performer_examples(motion, rest, keys);
    EXPECT_EQ(own.examples, (std::vector<std::string>{"open", "smile"}));
    EXPECT_LT((own.displacement_mm[1][2] - source.displacement_mm[0][2]).norm(), 1e-12);
    const auto lost = std::vector<KeyFrame>{{"gone", 82}}, late = std::vector<KeyFrame>{{"late", 90}};
    EXPECT_THAT(test::message_of([&] { (void)performer_examples(motion, rest, lost); }),
                HasSubstr("gone=82: the face is lost there"));
    EXPECT_THAT(test::message_of([&] { (void)performer_examples(motion, rest, late); }),
                HasSubstr("late=90: the motion has 90 frames"));
    EXPECT_THAT(test::message_of([&] { (void)performer_rest(motion, 82, 82); }), HasSubstr("the face is lost in all"));
}

TEST(ShapePerformance, arkit_shapes_drive_the_examples_that_stand_for_them) {
    capture::ShapeMotion motion;
    motion.shapes = {"mouthSmileLeft", "mouthSmileRight", "jawOpen"};
    motion.times_s = {0, 1.0 / 60, 2.0 / 60};
    motion.tracked = {1, 1, 0};
    motion.values = Eigen::MatrixXd(3, 3);
    motion.values << 0.2, 0.6, 0, 1.2, 0.8, 0.5, 0, 0, 0;
    FacialExamples character;
    character.examples = {
        {"smile", {"mouthSmileLeft", "mouthSmileRight"}, {}}, {"anger", {}, {}}, {"open", {"jawOpen"}, {}}};
    const auto mapped = map_shapes(motion, character);
    EXPECT_EQ(mapped.examples, (std::vector<std::string>{"smile", "open"}));
    EXPECT_DOUBLE_EQ(mapped.weights(0, 0), 0.4);
    EXPECT_DOUBLE_EQ(mapped.weights(1, 0), 1.0);
    EXPECT_DOUBLE_EQ(mapped.weights(1, 1), 0.5);
    EXPECT_DOUBLE_EQ(mapped.weights(2, 1), 0.5) << "held while the face is lost";
    character.examples = {{"anger", {}, {}}};
    EXPECT_THAT(test::message_of([&] { (void)map_shapes(motion, character); }), HasSubstr("no example stands for"));
}

}  // namespace
}  // namespace mimik::animation
