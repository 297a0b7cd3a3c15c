#include "capture/fill_gaps.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "facs/reference_face.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using geometry::Transform;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Transform pose(std::size_t frame) {
    Transform transform = Transform::Identity();
    transform.translate(Point(0, -2.0 * static_cast<double>(frame), 1));
    transform.rotate(Eigen::AngleAxisd(0.05 * static_cast<double>(frame), Point(0, 1, 3).normalized()));
    return transform;
}

geometry::Landmarks rest_places() { return place_markers(builtin_marker_set(), facs::reference_landmarks()); }

/// The whole set on the reference face, moved rigidly.
MarkerSequence rigid_take(std::size_t frames) {
    const auto places = rest_places();
    std::vector<std::string> names;
    for (const auto& marker : builtin_marker_set().markers) names.push_back(marker.name);
    MarkerSequence take(names, 120, frames, 5);
    for (std::size_t frame = 0; frame < frames; ++frame)
        for (std::size_t k = 0; k < names.size(); ++k) take.set(frame, k, pose(frame) * places.position_mm(names[k]));
    return take;
}

TEST(FillGaps, what_surrounds_a_marker_rigidly_brings_it_back_exactly) {
    const auto whole = rigid_take(12);
    auto take = whole;
    for (std::size_t k = 0; k < take.markers(); k += 5)
        for (std::size_t frame = k % 7; frame < k % 7 + 4; ++frame) take.set_missing(frame, k);
    const auto filled = fill_gaps(take);
    EXPECT_THAT(filled.remarks, IsEmpty());
    for (std::size_t frame = 0; frame < whole.frames(); ++frame)
        for (std::size_t k = 0; k < whole.markers(); ++k) {
            ASSERT_TRUE(filled.markers.valid(frame, k)) << whole.names()[k];
            EXPECT_LT((filled.markers.at_mm(frame, k) - whole.at_mm(frame, k)).norm(), 1e-9) << whole.names()[k];
        }
    EXPECT_EQ(filled.filled[5], 4U);
    EXPECT_EQ(filled.left[5], 0U);
}

TEST(FillGaps, a_marker_arrives_where_it_is_seen_again) {
    auto take = rigid_take(12);
    const auto lip = take.index("lip_lower_middle");
    // It moves by 6 mm of its own while it is hidden: from one end by nothing, from the other by all of it.
    for (std::size_t frame = 3; frame < 9; ++frame) take.set_missing(frame, lip);
    const Point own(0, -6, 0);
    for (std::size_t frame = 9; frame < 12; ++frame) take.set(frame, lip, take.at_mm(frame, lip) + own);
    const auto whole = rigid_take(12);
    const auto filled = fill_gaps(take);
    double last = 0;
    for (std::size_t frame = 3; frame < 9; ++frame) {
        const double off = (filled.markers.at_mm(frame, lip) - whole.at_mm(frame, lip)).norm();
        EXPECT_NEAR(off - last, 6.0 / 7, 1e-9) << "7 equal steps from one end to the other";
        last = off;
    }
}

TEST(FillGaps, nothing_that_was_seen_is_changed_and_what_cannot_be_said_is_left) {
    auto take = rigid_take(4);
    const auto chin = take.index("chin");
    const auto* group = builtin_marker_set().find("chin");
    ASSERT_NE(group, nullptr);
    take.set_missing(2, chin);
    for (std::size_t k = 2; k < group->group.size(); ++k) take.set_missing(2, take.index(group->group[k]));
    const auto filled = fill_gaps(take);
    EXPECT_FALSE(filled.markers.valid(2, chin)) << "two markers of its group are left, and say no rotation";
    EXPECT_EQ(filled.left[chin], 1U);
    for (std::size_t frame = 0; frame < take.frames(); ++frame)
        for (std::size_t k = 0; k < take.markers(); ++k)
            if (take.valid(frame, k)) {
                EXPECT_EQ(filled.markers.at_mm(frame, k), take.at_mm(frame, k));
            }
    FillOptions short_ones;
    short_ones.longest_gap_s = 0.5 / 120;
    EXPECT_THAT(fill_gaps(take, builtin_marker_set(), short_ones).remarks, ElementsAre(HasSubstr("longer than")));
}

TEST(FillGaps, markers_of_other_names_are_carried_by_the_nearest) {
    const auto whole = rigid_take(6);
    MarkerSequence take({"A:1", "A:2", "A:3", "A:4", "A:5"}, 120, 6);
    for (std::size_t frame = 0; frame < 6; ++frame)
        for (std::size_t k = 0; k < 5; ++k)
            if (k != 4 || frame < 3) take.set(frame, k, whole.at_mm(frame, 10 * k));
    const auto filled = fill_gaps(take);
    EXPECT_THAT(filled.remarks, ElementsAre(HasSubstr("1 marker has no group of the built-in marker set")));
    EXPECT_LT((filled.markers.at_mm(5, 4) - whole.at_mm(5, 40)).norm(), 1e-9);
}

TEST(DeriveMarkers, follow_sibling_and_group_rigidly) {
    const auto take = rigid_take(8);
    const auto places = rest_places();
    const auto derived = derive_markers(take, places);
    EXPECT_THAT(derived.remarks, IsEmpty());
    EXPECT_EQ(derived.derived.size(), 8U);
    for (const auto& name : derived.derived)
        for (std::size_t frame = 0; frame < take.frames(); ++frame)
            EXPECT_LT(
                (derived.markers.at_mm(frame, derived.markers.index(name)) - pose(frame) * places.position_mm(name))
                    .norm(),
                1e-9)
                << name;
}

TEST(DeriveMarkers, an_inner_lip_goes_with_its_own_lip_alone) {
    auto take = rigid_take(1);
    const auto places = rest_places();
    const Point down(0, -10, 0);
    for (std::size_t k = 0; k < take.markers(); ++k)
        if (take.names()[k].starts_with("lip_lower") || take.names()[k].starts_with("chin"))
            take.set(0, k, take.at_mm(0, k) + down);
    const auto derived = derive_markers(take, places);
    const auto moved = [&](const std::string& name) -> Point {
        return derived.markers.at_mm(0, derived.markers.index(name)) - pose(0) * places.position_mm(name);
    };
    EXPECT_LT((moved("lip_lower_inside_middle") - down).norm(), 1e-9);
    EXPECT_LT(moved("lip_upper_inside_middle").norm(), 1e-9);
}

TEST(DeriveMarkers, what_the_rest_does_not_have_is_not_made_and_what_hangs_in_the_air_is_named) {
    const auto take = rigid_take(1);
    EXPECT_THAT(derive_markers(take, geometry::Landmarks()).derived, IsEmpty());
    const geometry::Landmarks alone({{"lip_upper_inside_middle", Point(0, 0, 0), ""}});
    const auto derived = derive_markers(take, alone);
    EXPECT_THAT(derived.derived, IsEmpty());
    EXPECT_THAT(derived.remarks, ElementsAre(HasSubstr("lip_upper_inside_middle is not made")));
}

}  // namespace
}  // namespace mimik::capture
