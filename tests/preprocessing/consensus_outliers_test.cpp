#include "preprocessing/consensus_outliers.h"

#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "preprocessing/average_face.h"
#include "tests/support/analytic_face.h"

namespace mimik::preprocessing {
namespace {

using geometry::Landmark;
using geometry::Landmarks;
using geometry::Point;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

Landmarks changed(const Landmarks& set, const std::function<void(Landmark&)>& change) {
    std::vector<Landmark> marks(set.all().begin(), set.all().end());
    for (auto& mark : marks) change(mark);
    return Landmarks(std::move(marks));
}

/// People of other sizes, with marks up to 6 mm elsewhere, somewhere in the room.
std::vector<Landmarks> people(std::size_t count) {
    std::vector<Landmarks> sets;
    for (std::size_t k = 0; k < count; ++k) {
        const auto place = geometry::Transform(Eigen::Translation3d(20.0 * static_cast<double>(k), -30, 800) *
                                               Eigen::AngleAxisd(0.1 * static_cast<double>(k % 3), Point::UnitY()));
        std::size_t m = 0;
        sets.push_back(changed(
            geometry::transformed(test::AnalyticFace{0.9 + 0.05 * static_cast<double>(k % 5)}.landmarks(), place),
            [&](Landmark& mark) {
                ++m;
                mark.position_mm +=
                    Point(static_cast<double>((7 * k + 3 * m) % 13) - 6, static_cast<double>((5 * k + 11 * m) % 9) - 4,
                          static_cast<double>((3 * k + 5 * m) % 7) - 3);
            }));
    }
    return sets;
}

TEST(ConsensusOutliers, people_who_differ_are_left_in) {
    for (const std::size_t count : {2U, 3U, 5U, 40U}) EXPECT_THAT(sets_far_off(people(count)), IsEmpty()) << count;
    auto with_a_child = people(6);
    with_a_child[2] = geometry::transformed(with_a_child[2], geometry::Transform(Eigen::Scaling(0.75)));
    EXPECT_THAT(sets_far_off(with_a_child), IsEmpty());
}

TEST(ConsensusOutliers, a_lost_decimal_point_is_named_with_its_landmark) {
    for (const std::size_t count : {3U, 4U, 12U})
        for (std::size_t bad = 0; bad < count; ++bad) {
            auto sets = people(count);
            sets[bad] = changed(sets[bad], [](Landmark& mark) {
                if (mark.name == "eye_outer_left") mark.position_mm.x() *= 10;
            });
            const auto far = sets_far_off(sets);
            ASSERT_EQ(far.size(), 1U) << count << " " << bad;
            EXPECT_EQ(far[0].set, bad);
            EXPECT_THAT(far[0].reason,
                        AllOf(HasSubstr("its landmark 'eye_outer_left' lies "), HasSubstr("mark it again")));
        }
}

TEST(ConsensusOutliers, another_unit_another_shape_and_marks_on_one_line_are_named) {
    auto sets = people(8);
    sets[1] = geometry::transformed(sets[1], geometry::Transform(Eigen::Scaling(10.0)));
    sets[3] = geometry::transformed(sets[3], geometry::Transform(Eigen::Scaling(0.1)));
    sets[4] = changed(sets[4], [](Landmark& mark) { mark.position_mm.x() = -mark.position_mm.x(); });  // mirrored
    sets[6] = changed(sets[6], [](Landmark& mark) { mark.position_mm = {mark.position_mm.x(), 0, 0}; });
    const auto far = sets_far_off(sets);
    ASSERT_EQ(far.size(), 4U);
    EXPECT_THAT(far[0].reason, HasSubstr("times as large as those of the other neutral faces"));
    EXPECT_THAT(far[1].reason, HasSubstr("times as large as those of the other neutral faces"));
    EXPECT_THAT(far[2].reason, HasSubstr("from where the other neutral faces have"));
    EXPECT_THAT(far[3].reason, HasSubstr("lie on one line"));
    EXPECT_EQ(far[3].set, 6U);
}

TEST(ConsensusOutliers, a_third_of_bad_sets_does_not_move_the_rest) {
    auto sets = people(9);
    for (const std::size_t k : {0U, 4U, 8U})
        sets[k] = changed(sets[k], [&](Landmark& mark) {
            if (mark.name == "chin") mark.position_mm += Point(0, -200, 0);
        });
    EXPECT_EQ(sets_far_off(sets).size(), 3U);
}

}  // namespace
}  // namespace mimik::preprocessing
