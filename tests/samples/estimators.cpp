#include <gtest/gtest.h>

#include "tests/support/analytic_workspace.h"

// [sample]
#include "evaluation/active_zone.h"
#include "evaluation/case_estimates.h"
#include "evaluation/scored_region.h"

using namespace mimik;

/// The figures of one estimator for a motion of a neutral face, in the expression's zone and on the nose.
std::vector<evaluation::Measure> estimate(const std::string& name, const geometry::DisplacementField& field,
                                          const preprocessing::Face& neutral, const preprocessing::Face& expressive,
                                          const facs::Expression& expression,
                                          const preprocessing::AverageFace& average) {
    const auto& catalogue = facs::builtin_catalogue();
    const auto drawn = evaluation::shipped_active_zone(expression, average);
    const auto zone = evaluation::carry_zone(drawn, average, neutral);
    const auto surface = geometry::face_surface(neutral.grid, neutral.landmarks);
    const auto scored = evaluation::scored_target(surface, expressive.grid, expressive.neutral_from_scan, zone);
    const std::vector<std::string> regions = {"zone", "nose"};
    evaluation::EstimatedTarget target(scored, surface,
                                       evaluation::regions_on(neutral, average, catalogue, expression, zone, regions));
    const evaluation::JudgedFace face{scored, surface, field};
    evaluation::CaseEstimates estimates(target, face);
    return estimates.measure(evaluation::estimator_by_name(name), {.metrics = {"rms", "coverage"}});
}
// [end]

TEST(Samples, a_nose_that_holds_still_is_nearer_than_a_mouth_that_smiles) {
    const auto average = test::analytic_average();
    const auto subject = test::analytic_subject(average, 1.0, 6.0);
    const auto still = geometry::DisplacementField::still(subject.neutral.grid.size());
    double nose_mm = -1, zone_mm = -1;
    for (const auto& measure : estimate("signed", still, subject.neutral, subject.smiling,
                                        facs::builtin_catalogue().expression("12"), average))
        if (measure.metric == "rms") (measure.region == "nose" ? nose_mm : zone_mm) = *measure.value;
    EXPECT_GE(nose_mm, 0);
    EXPECT_GT(zone_mm, nose_mm);
}
