#include "preprocessing/landmark_error.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::preprocessing {
namespace {

geometry::Landmarks marks(int count) {
    std::vector<geometry::Landmark> marks;
    for (int k = 0; k < count; ++k) {
        geometry::Landmark mark;
        mark.name = "mark" + std::to_string(k);
        mark.position_mm = geometry::Point(k, 2 * k, -k);
        marks.push_back(mark);
    }
    return geometry::Landmarks(std::move(marks));
}

TEST(LandmarkError, moves_marks_by_the_mean_distance_that_is_asked_for) {
    const auto before = marks(4000), after = with_landmark_error(before, "bs000_N_N_0", {.mean_mm = 2});
    geometry::Point mean = geometry::Point::Zero();
    double mean_mm = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
        const geometry::Point way = after.all()[k].position_mm - before.all()[k].position_mm;
        mean += way / 4000.0;
        mean_mm += way.norm() / 4000.0;
    }
    // Four standard errors: of the length .84 mm / sqrt(4000), of a coordinate 1.25 mm / sqrt(4000).
    EXPECT_NEAR(mean_mm, 2, 0.054);
    EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.08);
}

TEST(LandmarkError, moves_a_mark_the_same_way_and_twice_as_far_for_twice_the_error) {
    const auto before = marks(22);
    const auto one = with_landmark_error(before, "bs000_N_N_0", {.mean_mm = 1, .seed = 3});
    const auto two = with_landmark_error(before, "bs000_N_N_0", {.mean_mm = 2, .seed = 3});
    for (std::size_t k = 0; k < before.size(); ++k) {
        const geometry::Point way = one.all()[k].position_mm - before.all()[k].position_mm;
        EXPECT_LT((two.all()[k].position_mm - before.all()[k].position_mm - 2 * way).norm(), 1e-12);
    }
}

TEST(LandmarkError, is_drawn_anew_for_each_scan_and_seed) {
    const auto before = marks(1);
    const auto at = [&](const char* scan, std::uint64_t seed) {
        return with_landmark_error(before, scan, {.mean_mm = 1, .seed = seed}).all()[0].position_mm;
    };
    EXPECT_EQ(at("bs000_N_N_0", 1), at("bs000_N_N_0", 1));
    EXPECT_NE(at("bs000_N_N_0", 1), at("bs000_N_N_0", 2));
    EXPECT_NE(at("bs000_N_N_0", 1), at("bs001_N_N_0", 1));
}

TEST(LandmarkError, of_nothing_leaves_every_mark_where_it_was) {
    const auto before = marks(5), after = with_landmark_error(before, "bs000_N_N_0", {});
    for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(before.all()[k].position_mm, after.all()[k].position_mm);
}

TEST(LandmarkError, refuses_errors_below_nothing_and_beyond_a_face) {
    EXPECT_THROW((void)with_landmark_error(marks(1), "a", {.mean_mm = -1}), InputError);
    EXPECT_THROW((void)with_landmark_error(marks(1), "a", {.mean_mm = 51}), InputError);
    EXPECT_THROW((void)with_landmark_error(marks(1), "a", {.mean_mm = std::nan("")}), InputError);
}

}  // namespace
}  // namespace mimik::preprocessing
