#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"

// [sample]
#include "preprocessing/template_registration.h"

using namespace mimik;

/// How far the skin of one subject moves at most, mm of the average face.
double largest_motion_mm(const preprocessing::AverageFace& average, const preprocessing::Face& neutral,
                         const preprocessing::Face& expressive) {
    const preprocessing::TemplateRegistration registration(preprocessing::build_face_template(average));
    const auto rest = registration.neutral(neutral);
    const auto moved = registration.motion(neutral, rest, expressive);
    double largest_mm = 0;
    for (const auto& motion : moved.motion_mm) largest_mm = std::max(largest_mm, motion.norm());
    return largest_mm;
}
// [end]

TEST(Samples, a_smile_of_six_millimetres_moves_the_skin_by_about_as_much) {
    const auto average = test::analytic_average();
    const auto subject = test::analytic_subject(average, 1.0, 6.0);
    EXPECT_NEAR(largest_motion_mm(average, subject.neutral, subject.smiling), 6.0, 1.5);
}
