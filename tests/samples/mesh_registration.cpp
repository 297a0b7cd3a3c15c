#include <gtest/gtest.h>

#include "tests/capture/curved_sheet.h"

// [sample]
#include "capture/label_fit.h"

using namespace mimik;

/// All labels of a reference face on another one, by a dozen of them that were placed on it by hand.
geometry::Landmarks labels_on(const geometry::SurfaceIndex& face, const geometry::Landmarks& by_hand,
                              const geometry::SurfaceIndex& reference, const geometry::Landmarks& labels) {
    const auto start = capture::start_labels(reference, labels, face, by_hand);
    const auto& set = capture::builtin_marker_set();  // its control surface keeps its shape
    return capture::fit_labels(start, labels, face, set, capture::SurfaceMinimiser::levenberg).labels;
}
// [end]

TEST(Samples, a_dozen_points_bring_all_labels_on_to_a_larger_face) {
    const test::CurvedSheet sheet;
    auto larger = sheet.vertices_mm;
    for (auto& p : larger) p *= 1.2;
    geometry::Transform grow = geometry::Transform::Identity();
    grow.scale(1.2);
    const auto truth = geometry::transformed(sheet.labels, grow);
    const auto labels =
        labels_on({larger, sheet.triangles}, geometry::transformed(sheet.points(), grow), sheet.index(), sheet.labels);
    ASSERT_EQ(labels.size(), 76U);
    for (const auto& label : labels.all())  // an affine map is met by every kernel; a ray meets the surface within this
        EXPECT_LT((label.position_mm - truth.position_mm(label.name)).norm(), 1e-3) << label.name;
}
