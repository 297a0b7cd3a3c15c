#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"
#include "tests/support/expressions.h"

// [sample]
#include "preprocessing/neutral_alignment.h"
#include "preprocessing/stable_region.h"

using namespace mimik;

/// Ties an expressive scan to the subject's neutral one, and by it to the average face.
void tie(preprocessing::Face& expressive, const facs::Expression& expression, const preprocessing::Face& neutral) {
    const auto stable = preprocessing::stable_vertices(facs::builtin_catalogue(), expression, neutral);
    preprocessing::align_to_neutral(expressive, neutral, stable);
    expressive.average_from_scan = neutral.average_from_scan * expressive.neutral_from_scan;
}
// [end]

TEST(Samples, a_smile_is_aligned_by_what_it_leaves_alone) {
    auto [neutral, smiling] = test::analytic_subject(test::analytic_average(), 1.0, 6.0);
    const geometry::Transform true_pose = smiling.neutral_from_scan;
    smiling.neutral_from_scan = geometry::Transform::Identity();
    tie(smiling, test::expression("12"), neutral);
    const auto tip = smiling.landmarks.position_mm("nose_tip");
    EXPECT_LT((smiling.neutral_from_scan * tip - true_pose * tip).norm(), 0.3);  // grids of 150 lines on 180 mm
}
