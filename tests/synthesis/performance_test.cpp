#include "synthesis/performance.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::synthesis {
namespace {

using test::message_of;
using testing::HasSubstr;

const FaceModel& model() {
    static const auto made = make_builtin_face_model();
    return *made;
}

const Performer& performer() {
    static const Performer one(model(), "actor", 1);
    return one;
}

PerformanceOptions short_options() {
    PerformanceOptions options;
    options.seconds = 1;
    options.seconds_a_unit = 0.1;
    return options;
}

TEST(Performance, has_68_markers_on_the_skin_and_a_jig_of_seven) {
    EXPECT_EQ(performer().marker_names().size(), 75U);
    EXPECT_EQ(performer().labels().size(), 76U);
    const std::vector<geometry::Vector> still(performer().resting_mm().size(), geometry::Vector::Zero());
    const auto at = performer().markers_mm(still);
    for (std::size_t k = 0; k < 68; ++k)
        EXPECT_LT((at[k] - performer().labels().position_mm(performer().marker_names()[k])).norm(), 1e-9);
}

TEST(Performance, labels_of_the_midline_are_on_it) {
    const auto places = capture::place_markers(capture::builtin_marker_set(), performer().landmarks());
    // What is marked there itself may be off it by as much as its landmark; what lies between landmarks may not.
    for (const char* name : {"nose_root", "nose_bridge", "glabella", "forehead_low", "forehead_high", "chin_fold"})
        EXPECT_NEAR(performer().labels().position_mm(name).x(), places.position_mm(name).x(), 1e-9) << name;
}

TEST(Performance, recording_a_ramps_every_unit_alone_from_rest_to_full_and_back) {
    const auto score = ramped_score(units_that_show(model()), short_options());
    ASSERT_EQ(score.frames(), 12 * score.units.size());
    EXPECT_GE(score.units.size(), 20U);
    for (std::size_t f = 0; f < score.frames(); ++f) {
        const auto active =
            std::count_if(score.strength[f].begin(), score.strength[f].end(), [](double s) { return s > 0; });
        EXPECT_EQ(active, f % 12 == 0 ? 0 : 1);
        if (f % 12 == 6) {
            EXPECT_EQ(score.strength[f][f / 12], 1.0);
        }
    }
}

TEST(Performance, exact_markers_are_where_the_skin_is) {
    Score score{{make_expression("26"), make_expression("12")}, 120, {{0, 0}, {0.5, 0}, {1, 0.3}}};
    const auto take = exact_recording(performer(), score);
    const auto chin = take.index("chin"), tip = take.index("nose_tip"), jig = take.index("jig_1");
    EXPECT_LT(take.at_mm(2, chin).y(), take.at_mm(0, chin).y() - 3) << "the jaw drops";
    EXPECT_LT((take.at_mm(2, tip) - take.at_mm(0, tip)).norm(), 1.0);
    EXPECT_EQ(take.at_mm(2, jig), take.at_mm(0, jig));
}

TEST(Performance, the_laboratory_adds_noise_gaps_and_head_motion_alike_for_one_seed) {
    auto options = short_options();
    options.drop_outs_a_minute = 120;
    const auto score = spoken_score({make_expression("26")}, options);
    const auto once = laboratory_recording(performer(), score, options);
    EXPECT_EQ(once, laboratory_recording(performer(), score, options));
    std::size_t missing = 0;
    for (std::size_t k = 0; k < 68; ++k) missing += once.frames() - once.valid_count(k);
    EXPECT_GT(missing, 0U);
    for (std::size_t k = 68; k < 75; ++k) EXPECT_EQ(once.valid_count(k), once.frames()) << "a jig is never lost";
    const auto jig = once.index("jig_1");
    EXPECT_GT((once.at_mm(once.frames() - 1, jig) - once.at_mm(0, jig)).norm(), 1.0) << "the head moves";
    options.seed = 2;
    EXPECT_NE(once, laboratory_recording(performer(), score, options));
}

TEST(Performance, options_out_of_range_are_named) {
    PerformanceOptions options;
    options.noise_mm = -1;
    EXPECT_THAT(message_of([&] { options.check(); }), HasSubstr("noise_mm is -1"));
}

}  // namespace
}  // namespace mimik::synthesis
