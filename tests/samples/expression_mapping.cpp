#include <gtest/gtest.h>

#include "tests/animation/performer.h"

// [sample]
#include "animation/blend_examples.h"
#include "animation/expression_mapping.h"

using namespace mimik;

/// A character's face in every frame of a performer's motion. The performer is at rest in the first half second.
/// @param shown      what the features do in each example, such as modeling::standard_source_examples()
/// @param character  neutral face and examples, in the order of `shown`
std::vector<std::vector<geometry::Point>> perform(const capture::FeatureMotion& motion,
                                                  const modeling::SourceExamples& shown,
                                                  const animation::ExampleBlender& character) {
    const auto rest = animation::performer_rest(motion, 0, static_cast<std::size_t>(motion.rate_hz / 2) - 1);
    const animation::ExpressionMapping mapping(animation::fitted_examples(shown, motion, rest));
    const auto mapped = animation::map_performance(motion, rest, mapping);
    std::vector<std::vector<geometry::Point>> faces;
    for (const Eigen::VectorXd weights : mapped.weights.rowwise()) {
        auto& face = faces.emplace_back(character.vertices());
        character.blend({weights.data(), static_cast<std::size_t>(weights.size())}, face);
    }
    return faces;
}
// [end]

TEST(Samples, a_character_of_one_vertex_does_what_the_performer_does) {
    const auto shown = test::three_examples();
    const animation::ExampleBlender character(
        {{0, 0, 0}}, std::vector<std::vector<geometry::Vector>>{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}});
    const auto faces = perform(test::performed(shown, 60, 0.0), shown, character);
    ASSERT_EQ(faces.size(), 60U);
    EXPECT_LT(faces[5][0].norm(), 1e-9);
    // Between examples the ridge of a thousandth takes some hundredths.
    for (Eigen::Index i = 0; i < 3; ++i)
        EXPECT_NEAR(faces[40][0][i], test::known_weight(static_cast<std::size_t>(i), 40.0 / 30), 0.1) << i;
}
