#include "evaluation/estimator_choice.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

using testing::HasSubstr;

TEST(EstimatorNames, both_spellings_name_the_same_estimator_and_rows_carry_the_short_one) {
    std::set<std::string> names;
    for (const auto& one : estimator_definitions()) {
        EXPECT_EQ(estimator_by_name(one.name), one.choice);
        EXPECT_EQ(estimator_by_name(one.spelled), one.choice);
        EXPECT_EQ(to_string(one.choice), one.name);
        EXPECT_TRUE(names.insert(one.name).second) << one.name << " stands twice";
        EXPECT_FALSE(one.definition.empty() || one.blind_to.empty() || one.unit.empty());
    }
    EXPECT_EQ(estimator_by_name("closest-point/point-to-surface"), EstimatorChoice{});
    EXPECT_EQ(to_string(EstimatorChoice{}), "point-to-surface");
}

TEST(EstimatorNames, an_alignment_stands_before_the_name) {
    const auto signed_by_marks = estimator_by_name("landmarks/signed");
    EXPECT_EQ(signed_by_marks.alignment, Alignment::landmarks);
    EXPECT_EQ(signed_by_marks.distance, Distance::along_normal);
    EXPECT_EQ(to_string(signed_by_marks), "landmarks/signed");
    EXPECT_EQ(to_string(estimator_by_name("given/signed")), "signed");
    EXPECT_EQ(estimator_by_name("stable-region/closest-point/signed").alignment, Alignment::stable_region);
}

TEST(EstimatorNames, one_that_is_unknown_is_refused_with_those_there_are) {
    const auto said = test::message_of([] { (void)estimator_by_name("icp"); });
    EXPECT_THAT(said, HasSubstr("estimator 'icp' is unknown; there are: point-to-surface, point-to-point, signed"));
    EXPECT_THAT(said, HasSubstr("(given, none, landmarks, stable-region)"));
    EXPECT_THAT(test::message_of([] { (void)alignment_by_name("icp"); }), HasSubstr("alignment 'icp' is unknown"));
}

}  // namespace
}  // namespace mimik::evaluation
