#include <gtest/gtest.h>

#include "animation/method.h"
#include "tests/support/analytic_workspace.h"

// [sample]
#include "evaluation/active_zone.h"
#include "evaluation/estimator.h"

using namespace mimik;

/// How much of a real expression a motion of the neutral face explains, where the catalogue says that it shows.
double explained_by(const geometry::DisplacementField& field, const preprocessing::Face& neutral,
                    const preprocessing::Face& expressive, const facs::Expression& expression,
                    const preprocessing::AverageFace& average) {
    const auto drawn = evaluation::shipped_active_zone(expression, average);
    const auto zone = evaluation::carry_zone(drawn, average, neutral);
    const auto surface = geometry::face_surface(neutral.grid, neutral.landmarks);
    const auto target = evaluation::scored_target(surface, expressive.grid, expressive.neutral_from_scan, zone);
    const auto still = geometry::DisplacementField::still(surface.size());
    const double error_mm = evaluation::distances_to_real_scan({target, surface, field}).zone_mm;
    const double nothing_mm = evaluation::distances_to_real_scan({target, surface, still}).zone_mm;
    return 1 - error_mm / nothing_mm;
}
// [end]

TEST(Samples, doing_nothing_explains_nothing_and_the_default_something) {
    const auto average = test::analytic_average();
    const auto source = test::analytic_subject(average, 1.0, 6.0), target = test::analytic_subject(average, 1.1, 6.0);
    const auto& catalogue = facs::builtin_catalogue();
    const auto smile = catalogue.expression("12");
    const auto still = geometry::DisplacementField::still(target.neutral.grid.size());
    EXPECT_EQ(explained_by(still, target.neutral, target.smiling, smile, average), 0);
    const modeling::Performance performance{source.neutral, source.smiling, source.smiling.neutral_from_scan,
                                            std::nullopt, std::nullopt};
    const auto transfer = animation::learn(*animation::method_by_name("default"), {smile, average, catalogue},
                                           std::span(&performance, 1));
    const auto field = transfer->on(animation::PreparedTarget(target.neutral));
    EXPECT_GT(explained_by(field, target.neutral, target.smiling, smile, average), 0.3);
}
