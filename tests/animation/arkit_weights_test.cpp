#include "animation/arkit_weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ArkitWeights, units_become_the_shapes_that_arkit_has) {
    const std::vector<std::string> units = {"AU1_L", "AU1_R", "AU12_L", "AU16", "AU27"};
    const std::vector<std::vector<double>> strengths = {{0, 0, 0, 0, 0}, {1, 0.5, 0.25, 0.7, 1.2}};
    const auto motion = arkit_weights(facs::builtin_catalogue(), units, strengths, 30);
    EXPECT_THAT(motion.shapes, ElementsAre("browInnerUp", "jawOpen", "mouthSmileLeft"));
    EXPECT_TRUE(motion.values.row(0).isZero(0));
    EXPECT_EQ(motion.values(1, 0), 0.75) << "the mean of both halves";
    EXPECT_EQ(motion.values(1, 1), 1.0);
    EXPECT_EQ(motion.values(1, 2), 0.25);
    EXPECT_EQ(motion.times_s[1], 1.0 / 30);
    EXPECT_THAT(motion.remarks, ElementsAre(HasSubstr("no shape of AU16"), HasSubstr("1 weight is above 1")));
}

TEST(ArkitWeights, of_two_units_of_one_shape_the_stronger_is_taken) {
    const std::vector<std::string> units = {"AU26", "AU27"};
    const std::vector<std::vector<double>> strengths = {{0.4, 0.1}};
    EXPECT_EQ(arkit_weights(facs::builtin_catalogue(), units, strengths, 30).values(0, 0), 0.4);
    const std::vector<std::vector<double>> short_row = {{0.4}};
    EXPECT_THAT(test::message_of([&] { (void)arkit_weights(facs::builtin_catalogue(), units, short_row, 30); }),
                HasSubstr("frame 1 has 1 strengths; there are 2 units"));
}

}  // namespace
}  // namespace mimik::animation
