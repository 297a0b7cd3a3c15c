#include <cmath>

#include <gtest/gtest.h>

#include "capture/marker_set.h"
#include "facs/reference_face.h"

// [sample]
#include "capture/fill_gaps.h"
#include "capture/motion_file.h"
#include "capture/retarget.h"
#include "capture/stabilise.h"

using namespace mimik;

/// A take on another face: without the motion of the head, without gaps, in the frame of the labels.
capture::MarkerSequence on_face(const capture::MarkerSequence& take, const geometry::Landmarks& labels,
                                const std::vector<std::string>& jig) {
    capture::StabiliseOptions options;
    options.jig = jig;  // empty: a robust fit over the face's own markers
    const auto still = capture::stabilise(take, options);
    const auto whole = capture::fill_gaps(still.markers);
    const auto there = capture::retarget(whole.markers, labels);
    return capture::derive_markers(there.markers, labels).markers;  // inner lips, outer eye corners
}
// [end]

TEST(Samples, a_take_lands_on_the_labels_of_another_face) {
    const auto& set = capture::builtin_marker_set();
    const auto places = capture::place_markers(set, facs::reference_landmarks());
    std::vector<std::string> names;
    for (const auto& marker : set.markers) names.push_back(marker.name);
    capture::MarkerSequence take(names, 120, 3);
    for (std::size_t frame = 0; frame < 3; ++frame) {
        geometry::Transform head = geometry::Transform::Identity();
        head.translate(geometry::Point(0, 5.0 * static_cast<double>(frame), 0));
        for (std::size_t k = 0; k < names.size(); ++k)
            if (frame != 1 || k % 9 != 0) take.set(frame, k, head * places.position_mm(names[k]));
    }
    geometry::Transform larger = geometry::Transform::Identity();
    larger.scale(1.2);
    const auto labels = geometry::transformed(places, larger);
    const auto there = on_face(take, labels, {});
    EXPECT_EQ(there.markers(), 76U);
    for (std::size_t frame = 0; frame < 3; ++frame)
        for (std::size_t k = 0; k < there.markers(); ++k)
            // The head is all that moves, so every frame is the rest; coordinates of 100 mm leave 1e-8 in the system.
            EXPECT_LT((there.at_mm(frame, k) - labels.position_mm(there.names()[k])).norm(), 1e-5);
}
