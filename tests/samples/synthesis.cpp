#include <gtest/gtest.h>

// [sample]
#include "synthesis/scanner.h"
#include "synthesis/subject.h"

using namespace mimik;

/// A scan of a person's smile. The same seed gives the same person, the same smile and the same noise.
synthesis::SyntheticScan scanned_smile(const synthesis::FaceModel& model, std::uint64_t seed) {
    const std::string name = "bs000_LFAU_12_0";  // names the streams of chance
    const auto subject = synthesis::draw_subject(model, "bs000", seed);
    const auto smile = synthesis::perform(subject, synthesis::make_expression("AU12"), name, seed);
    return synthesis::scan_face(model, smile.vertices_mm, synthesis::face_window(model, subject.resting_mm), name,
                                seed);
}
// [end]

TEST(Samples, a_scan_of_a_smile_has_points_holes_and_marks) {
    const auto model = synthesis::make_builtin_face_model();
    const auto scan = scanned_smile(*model, 1);
    EXPECT_GT(scan.valid_points, 25000U);
    EXPECT_GT(scan.lost_holes, 0U);
    EXPECT_GE(scan.landmarks.size(), 20U);
    EXPECT_EQ(scan.true_landmarks.size(), 22U);
}
