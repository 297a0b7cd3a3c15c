#include "capture/retarget.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/marker_set.h"
#include "facs/reference_face.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using geometry::Landmark;
using geometry::Landmarks;
using geometry::Transform;
using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Landmarks places() { return place_markers(builtin_marker_set(), facs::reference_landmarks()); }

/// The 68 markers on the reference face, the lower ones going up and down; three frames are at rest.
MarkerSequence take(std::size_t frames = 20) {
    const auto at = places();
    std::vector<std::string> names;
    for (const auto& marker : builtin_marker_set().markers) names.push_back(marker.name);
    MarkerSequence sequence(names, 120, frames, 10);
    for (std::size_t frame = 0; frame < frames; ++frame)
        for (std::size_t k = 0; k < names.size(); ++k) {
            Point p = at.position_mm(names[k]);
            if (p.y() < 0 && frame > 2) p += Point(0.3, -8, 1) * std::sin(0.3 * static_cast<double>(frame));
            sequence.set(frame, k, p);
        }
    return sequence;
}

/// Labels at `target_from_source` of where the markers are at rest, each bent off by up to 4 mm.
Landmarks labels(const Transform& target_from_source, double bend_mm) {
    std::vector<Landmark> list;
    double phase = 0;
    const auto at = places();
    for (const auto& mark : at.all()) {
        phase += 1;
        list.push_back({mark.name,
                        target_from_source * mark.position_mm +
                            bend_mm * Point(std::sin(phase), std::cos(2 * phase), std::sin(3 * phase)),
                        ""});
    }
    return Landmarks(std::move(list));
}

Transform larger_face() {
    Transform map = Transform::Identity();
    map.translate(Point(3, 100, -40));
    map.rotate(Eigen::AngleAxisd(0.3, Point(0, 1, 0.2).normalized()));
    map.scale(Point(1.2, 1.1, 1.3));
    return map;
}

TEST(Retarget, the_rest_frame_lands_on_the_labels_with_every_kernel) {
    const auto target = labels(larger_face(), 4);
    for (const auto kernel :
         {geometry::RadialKernel::inverse_multiquadric, geometry::RadialKernel::gaussian,
          geometry::RadialKernel::wendland, geometry::RadialKernel::r, geometry::RadialKernel::r2_log_r2}) {
        RetargetOptions options;
        options.basis.kernel = kernel;
        const auto made = retarget(take(), target, options);
        EXPECT_EQ(made.rest_frame, 10);
        for (std::size_t k = 0; k < made.markers.markers(); ++k)
            // A thousandth of what a recording can tell; solving leaves 1e-8 of 100 mm.
            EXPECT_LT((made.markers.at_mm(1, k) - target.position_mm(made.markers.names()[k])).norm(), 1e-4)
                << to_string(kernel);
    }
}

TEST(Retarget, a_face_that_is_an_affine_image_moves_as_that_image) {
    const auto source = take();
    const auto made = retarget(source, labels(larger_face(), 0));
    for (std::size_t frame = 0; frame < source.frames(); ++frame)
        for (std::size_t k = 0; k < source.markers(); ++k)
            EXPECT_LT((made.markers.at_mm(frame, k) - larger_face() * source.at_mm(frame, k)).norm(), 1e-6);
    EXPECT_NEAR(made.scale, std::cbrt(1.2 * 1.1 * 1.3), 1e-9);
    EXPECT_THAT(made.remarks, ElementsAre(HasSubstr("8 labels are not in the recording")));
}

TEST(Retarget, what_is_not_labelled_is_left_out_by_name_and_what_is_missing_stays_missing) {
    auto source = take();
    source.set_missing(5, source.index("chin"));
    std::vector<Landmark> some;
    const auto at = places();
    for (const auto& mark : at.all())
        if (source.find(mark.name) && mark.name != "nose_tip") some.push_back(mark);
    const auto made = retarget(source, Landmarks(some));
    EXPECT_EQ(made.markers.markers(), 67U);
    EXPECT_FALSE(made.markers.valid(5, made.markers.index("chin")));
    EXPECT_TRUE(made.markers.valid(6, made.markers.index("chin")));
    EXPECT_THAT(made.remarks, ElementsAre(HasSubstr("1 marker has no label on the target; left out: nose_tip")));
}

TEST(Retarget, the_rest_is_the_first_frame_with_the_most_markers_or_the_one_asked_for) {
    auto source = take();
    source.set_missing(0, 0);
    EXPECT_EQ(retarget(source, places()).rest_frame, 11);
    RetargetOptions options;
    options.rest_frame = 10;
    const auto made = retarget(source, places(), options);
    EXPECT_EQ(made.rest_frame, 10);
    EXPECT_TRUE(made.markers.valid(1, 0)) << "the others carry it";
    options.rest_frame = 9;
    EXPECT_THAT(message_of([&] { (void)retarget(source, places(), options); }),
                HasSubstr("rest_frame is 9; there are 10 to 29"));
    EXPECT_THAT(message_of([&] { (void)retarget(source, Landmarks()); }), HasSubstr("4 are the least"));
}

}  // namespace
}  // namespace mimik::capture
