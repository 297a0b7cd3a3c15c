#include "geometry/landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::geometry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Landmarks, a_name_that_appears_twice_is_refused_by_name) {
    try {
        Landmarks({{"chin", {0, 0, 0}, ""}, {"chin", {1, 0, 0}, ""}});
        FAIL() << "accepted";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("'chin' appears twice"));
    }
}

TEST(Landmarks, a_missing_name_is_reported_with_the_names_there_are) {
    const Landmarks marks({{"chin", {0, 0, 0}, ""}, {"nose_tip", {0, 1, 0}, ""}});
    EXPECT_EQ(marks.find("brow"), nullptr);
    try {
        (void)marks.at("brow");
        FAIL() << "found";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("chin, nose_tip"));
    }
}

TEST(Landmarks, pairing_goes_by_name_and_says_what_found_no_partner) {
    const Landmarks a({{"chin", {0, 0, 0}, ""}, {"only_a", {1, 0, 0}, ""}});
    const Landmarks b({{"only_b", {0, 0, 0}, ""}, {"chin", {5, 0, 0}, ""}});
    const auto pairing = pair_by_name(a, b);
    ASSERT_EQ(pairing.pairs.size(), 1U);
    EXPECT_EQ(pairing.pairs[0].target_mm.x(), 5);
    EXPECT_THAT(pairing.only_in_source, ElementsAre("only_a"));
    EXPECT_THAT(pairing.only_in_target, ElementsAre("only_b"));
}

TEST(LandmarkNames, mirroring_twice_gives_the_name_back) {
    for (const auto name : standard_landmark_names()) EXPECT_EQ(mirrored_name(mirrored_name(name)), name);
    EXPECT_EQ(mirrored_name("eye_outer_left"), "eye_outer_right");
    EXPECT_EQ(mirrored_name("chin"), "chin");
}

}  // namespace
}  // namespace mimik::geometry
