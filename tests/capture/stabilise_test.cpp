#include "capture/stabilise.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/marker_set.h"
#include "facs/reference_face.h"
#include "tests/capture/recordings.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using geometry::Transform;
using test::message_of;
using testing::HasSubstr;

const std::vector<std::string> jig = {"jig_1", "jig_2", "jig_3", "jig_4"};

Transform head_pose(std::size_t frame) {
    const double t = 0.05 * static_cast<double>(frame);
    Transform pose = Transform::Identity();
    pose.translate(Point(20 * std::sin(t), 30 * t, -5 * t));
    pose.rotate(Eigen::AngleAxisd(0.4 * std::sin(1.3 * t), Point(1, 2, -1).normalized()));
    return pose;
}

/// The reference face with a jig over it; the mouth opens and closes by 20 mm, the head nods and turns.
struct Take {
    MarkerSequence moving, still_head;

    explicit Take(std::size_t frames = 40) {
        const auto places = place_markers(builtin_marker_set(), facs::reference_landmarks());
        std::vector<std::string> names;
        std::vector<Point> at;
        for (const auto& marker : builtin_marker_set().markers) {
            names.push_back(marker.name);
            at.push_back(places.position_mm(marker.name));
        }
        for (std::size_t k = 0; k < jig.size(); ++k) {
            names.push_back(jig[k]);
            at.emplace_back(k < 2 ? -60 : 60, 120, k % 2 == 0 ? -40 : -90);
        }
        moving = still_head = MarkerSequence(names, 120, frames);
        for (std::size_t frame = 0; frame < frames; ++frame) {
            const double open_mm = 10 - 10 * std::cos(0.3 * static_cast<double>(frame));
            for (std::size_t k = 0; k < names.size(); ++k) {
                Point p = at[k];
                if (p.y() < -35) p.y() -= open_mm;
                still_head.set(frame, k, p);
                moving.set(frame, k, head_pose(frame) * p);
            }
        }
    }
};

double largest_difference_mm(const MarkerSequence& a, const MarkerSequence& b, const Transform& b_from_a) {
    double largest = 0;
    for (std::size_t frame = 0; frame < a.frames(); ++frame)
        for (std::size_t k = 0; k < a.markers(); ++k)
            largest = std::max(largest, (b_from_a * a.at_mm(frame, k) - b.at_mm(frame, k)).norm());
    return largest;
}

TEST(Stabilise, a_jig_takes_the_heads_motion_off_exactly) {
    const Take take;
    StabiliseOptions options;
    options.jig = jig;
    const auto found = stabilise(take.moving, options);
    EXPECT_EQ(found.rest_frame, 0U);
    // Rounding alone: coordinates of 200 mm.
    EXPECT_LT(largest_difference_mm(found.markers, take.still_head, head_pose(0).inverse()), 1e-9);
    for (const auto& residual : found.residual_mm) EXPECT_LT(residual.value(), 1e-9);
}

TEST(Stabilise, without_a_jig_the_markers_that_move_lose_their_say) {
    const Take take;
    StabiliseOptions options;
    options.noise_mm = 0.01;  // the take has none
    const auto found = stabilise(take.moving, options);
    // Of 72 markers 20 move by up to 20 mm, and a plain fit follows them by millimetres. What moves by less than 5
    // times the noise keeps its say: 0.0014 mm in one frame.
    EXPECT_LT(largest_difference_mm(found.markers, take.still_head, head_pose(0).inverse()), 2e-3);
}

TEST(Stabilise, the_residual_is_how_far_the_jig_is_from_rigid) {
    Take take(3);
    // One of four markers bent by 2 mm: the residual is below that, and no frame else has one.
    const auto bent = take.moving.index("jig_2");
    take.moving.set(1, bent, take.moving.at_mm(1, bent) + Point(0, 2, 0));
    StabiliseOptions options;
    options.jig = jig;
    const auto found = stabilise(take.moving, options);
    EXPECT_GT(found.residual_mm[1].value(), 0.1);
    EXPECT_LT(found.residual_mm[1].value(), 1.0) << "2 mm over the root of four markers";
    EXPECT_LT(found.residual_mm[2].value(), 1e-9);
}

TEST(Stabilise, the_noise_of_the_rest_frame_does_not_pass_into_every_pose) {
    // One jig marker is 1 mm off in the rest frame alone. Fitted to that frame every pose would be off by it.
    Take take(41);
    const auto bent = take.moving.index("jig_2");
    take.moving.set(0, bent, take.moving.at_mm(0, bent) + Point(0, 1, 0));
    StabiliseOptions options;
    options.jig = jig;
    const auto found = stabilise(take.moving, options);
    for (std::size_t frame = 1; frame < 41; ++frame) EXPECT_LT(found.residual_mm[frame].value(), 1e-9);
}

TEST(Stabilise, frames_in_which_the_jig_says_no_rotation_have_no_pose) {
    Take take(6);
    for (const auto* name : {"jig_1", "jig_2"}) take.moving.set_missing(3, take.moving.index(name));
    StabiliseOptions options;
    options.jig = jig;
    const auto found = stabilise(take.moving, options);
    EXPECT_FALSE(found.residual_mm[3].has_value());
    EXPECT_FALSE(found.markers.valid(3, 0));
    EXPECT_TRUE(found.markers.valid(4, 0));
    EXPECT_THAT(found.remarks, testing::ElementsAre(HasSubstr("1 frame has no pose")));
}

TEST(Stabilise, what_makes_no_jig_is_refused) {
    const Take take(2);
    StabiliseOptions options;
    options.jig = {"jig_1", "jig_2"};
    EXPECT_THAT(message_of([&] { (void)stabilise(take.moving, options); }),
                HasSubstr("jig names 2 markers; three are"));
    options.jig = {"jig_1", "jig_2", "jig_2"};
    EXPECT_THAT(message_of([&] { (void)stabilise(take.moving, options); }), HasSubstr("jig names a marker twice"));
    options.jig = {"jig_1", "jig_2", "jig_9"};
    EXPECT_THAT(message_of([&] { (void)stabilise(take.moving, options); }), HasSubstr("there is no marker 'jig_9'"));
    MarkerSequence line({"a", "b", "c"}, 1, 1);
    for (std::size_t k = 0; k < 3; ++k) line.set(0, k, Point(static_cast<double>(k), 0, 0));
    EXPECT_THAT(message_of<NumericalError>([&] { (void)stabilise(line); }), HasSubstr("off one line"));
}

}  // namespace
}  // namespace mimik::capture
