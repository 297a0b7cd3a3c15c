#include "evaluation/tune_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "tests/evaluation/smile_with_point.h"

namespace mimik::evaluation {
namespace {

class TunePoints : public test::SmileWorkspace {
protected:
    static TunedUnit tuned(const facs::FacsCatalogue& catalogue, TuneOptions options) {
        options.carried = false;
        options.most_vertices = 300;
        const std::vector<TuneGroup> training = {{reader_, {"bs000", "bs001"}}}, unseen = {{reader_, {"bs002"}}};
        FailureList failures;
        const animation::MethodPointer method = animation::method_by_name("thesis");
        return tune_points(training, unseen, catalogue, 12, dynamic_cast<const animation::ModelMethod&>(*method),
                           options, failures);
    }
};

TEST_F(TunePoints, brings_a_point_that_was_put_off_back_to_where_it_does_best) {
    TuneOptions options;
    const auto good = tuned(test::smile_with_point(0), options);
    for (const double off_mm : {-4.0, 4.0}) {
        const auto bad = tuned(test::smile_with_point(off_mm), options);
        ASSERT_EQ(bad.points.size(), 1U);  // what is carried stays
        EXPECT_EQ(bad.points.front().name, "corner");
        ASSERT_EQ(bad.training.size(), 1U);
        EXPECT_GT(bad.training.front().before_mm, good.training.front().before_mm);
        EXPECT_LT(bad.training.front().after_mm, bad.training.front().before_mm);
        // From every start the search ends at the same place, within its last step.
        EXPECT_NEAR(bad.points.front().up * test::outer_eyes_mm, good.points.front().up * test::outer_eyes_mm,
                    options.search.last_step);
        EXPECT_NEAR(bad.training.front().after_mm, good.training.front().after_mm,
                    0.01 * good.training.front().nothing_mm);
        EXPECT_TRUE(bad.converged);
        EXPECT_EQ(bad.training.front().cases, 2U);
        EXPECT_EQ(bad.unseen.front().cases, 1U);
    }
}

TEST_F(TunePoints, moves_no_point_farther_than_it_may_and_writes_what_it_scored) {
    TuneOptions options;
    options.most_mm = 2;
    const auto catalogue = test::smile_with_point(7);
    const auto found = tuned(catalogue, options);
    EXPECT_LE(found.points.front().moved_mm, 2 + 1e-9);
    EXPECT_GT(found.points.front().moved_mm, 1);
    options.search.most_evaluations = 1;  // the start alone: what the catalogue scores as it stands
    EXPECT_DOUBLE_EQ(tuned(with_moved_points(catalogue, found), options).training.front().before_mm,
                     found.training.front().after_mm);
}

TEST_F(TunePoints, gives_the_same_points_for_any_number_of_threads) {
    std::vector<TunedUnit> found;
    for (const int threads : {1, 2}) {
        base::set_thread_count(threads);
        found.push_back(tuned(test::smile_with_point(4), {}));
    }
    base::set_thread_count(0);
    EXPECT_EQ(found[0].points.front().up, found[1].points.front().up);
    EXPECT_EQ(found[0].points.front().lateral, found[1].points.front().lateral);
    EXPECT_EQ(found[0].evaluations, found[1].evaluations);
    EXPECT_EQ(found[0].training.front().after_mm, found[1].training.front().after_mm);
}

TEST_F(TunePoints, refuses_what_cannot_be_tuned) {
    const auto catalogue = test::smile_with_point(0);
    const std::vector<TuneGroup> training = {{reader_, {"bs000"}}};
    FailureList failures;
    const auto method = animation::method_by_name("thesis"), dense = animation::method_by_name("default");
    const auto tune = [&](const animation::Method& by, int unit, const TuneOptions& options) {
        (void)tune_points(training, {}, catalogue, unit, dynamic_cast<const animation::ModelMethod&>(by), options,
                          failures);
    };
    EXPECT_THROW(tune(*dense, 12, {}), InputError);
    EXPECT_THROW(tune(*method, 4, {}), InputError);
    TuneOptions options;
    options.most_mm = 0;
    EXPECT_THROW(tune(*method, 12, options), InputError);
}

}  // namespace
}  // namespace mimik::evaluation
