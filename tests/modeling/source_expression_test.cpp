#include "modeling/source_expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/expressions.h"
#include "tests/support/workspace_test.h"

namespace mimik::modeling {
namespace {

using database::message_of;
using preprocessing::Workspace;
using testing::ElementsAre;
using testing::HasSubstr;

class SourceExpression : public test::WorkspaceTest<SourceExpression> {
protected:
    static ExpressionModel model(const std::string& code, const ExpressionSource& source) {
        return model_from_workspace(*workspace_, facs::builtin_catalogue(), test::expression(code), source);
    }
};

TEST_F(SourceExpression, one_side_comes_from_the_two_sided_scan_where_there_is_no_other) {
    const auto left = model("12L", {"bs001", {}});
    EXPECT_EQ(left.expression.name(), "AU12_L");
    EXPECT_THAT(left.sources, ElementsAre("bs001_N_N_0", "bs001_LFAU_12_0"));
    for (const auto& point : left.points)
        if (point.kind == facs::ControlKind::muscle) {
            EXPECT_THAT(point.name, HasSubstr("_left"));
        }
}

TEST_F(SourceExpression, an_expression_is_found_however_it_is_spelt) {
    for (const auto* word : {"AU12_L", "12l"}) {
        EXPECT_THAT(model(word, {"bs001", {}}).sources, ElementsAre("bs001_N_N_0", "bs001_LFAU_12_0")) << word;
        EXPECT_EQ(model(word, {"mean", {}}).sources.size(), 6U) << word;
    }
    EXPECT_EQ(model("au12", {"mean", {}}).expression.name(), "AU12");
}

TEST_F(SourceExpression, a_mean_leaves_out_the_target_and_takes_all_others) {
    const auto mean = model("12", {"mean", {"bs001"}});
    EXPECT_THAT(mean.sources, ElementsAre("bs000_N_N_0", "bs000_LFAU_12_0", "bs002_N_N_0", "bs002_LFAU_12_0"));
    ExpressionMean sum;
    for (const auto* other : {"bs000", "bs002"}) sum.add(model("12", {other, {}}));
    const auto by_hand = sum.mean();
    ASSERT_EQ(mean.points.size(), by_hand.points.size());
    for (std::size_t k = 0; k < mean.points.size(); ++k)
        EXPECT_EQ(mean.points[k].displacement_mm, by_hand.points[k].displacement_mm);
}

TEST_F(SourceExpression, what_is_not_there_is_named_with_what_there_is) {
    EXPECT_THAT(message_of<InputError>([] {
                    (void)model("17", {"bs001", {}});
                }),
                HasSubstr("'bs001' has no scan of expression '17'; there are: 12"));
    EXPECT_THAT(message_of<InputError>([] {
                    (void)model("12", {"bs009", {}});
                }),
                HasSubstr("'bs009' has no neutral face there; there are: bs000, bs001, bs002"));
    EXPECT_THAT(message_of<InputError>([] {
                    (void)model("12", {"mean", {"bs000", "bs001", "bs002"}});
                }),
                HasSubstr("no other subject shows expression '12'"));
    EXPECT_THAT(message_of<InputError>([] {
                    (void)model("99", {"mean", {}});
                }),
                HasSubstr("AU99 is not in the catalogue; there are: 1, 2, 4"));
}

TEST_F(SourceExpression, subjects_who_must_not_be_shown_are_no_source_and_in_no_mean) {
    const database::TemporaryFolder folder;
    base::write_atomically(folder.path() / "db" / "unallowed_subjects.txt", "bs000\n");
    const auto workspace = test::analytic_workspace(folder.path());
    EXPECT_THAT(
        message_of<InputError>([&] {
            (void)model_from_workspace(workspace, facs::builtin_catalogue(), test::expression("12"), {"bs000", {}});
        }),
        HasSubstr("'bs000' stands in unallowed_subjects.txt"));
    const auto mean =
        model_from_workspace(workspace, facs::builtin_catalogue(), test::expression("12"), {"mean", {"bs001"}});
    EXPECT_THAT(mean.sources, ElementsAre("bs002_N_N_0", "bs002_LFAU_12_0"));
}

TEST_F(SourceExpression, a_damaged_scan_leaves_the_mean_of_the_rest_and_is_kept_apart_from_points_left_out) {
    const database::TemporaryFolder folder;
    const auto workspace = test::analytic_workspace(folder.path());
    base::write_atomically(workspace.root() / "faces" / "bs000" / "bs000_LFAU_12_0.json", "{}");
    const auto mean = model_from_workspace(workspace, facs::builtin_catalogue(), test::expression("12"), {"mean", {}});
    EXPECT_EQ(mean.sources.size(), 4U);
    EXPECT_THAT(mean.unusable_scans, ElementsAre(HasSubstr("bs000_LFAU_12_0")));
    EXPECT_THAT(mean.left_out, testing::Not(testing::Contains(HasSubstr("bs000_LFAU_12_0"))));
}

TEST_F(SourceExpression, the_thesis_has_no_mean_and_that_is_said_before_any_work) {
    const ExpressionSource mean{"mean", {"bs001"}};
    const auto words = testing::AllOf(HasSubstr("the thesis method has no mean"), HasSubstr("one of bs000, bs002"));
    EXPECT_THAT(message_of<InputError>([&] { check_source(*workspace_, mean, ModelOptions::thesis()); }), words);
    EXPECT_THAT(message_of<InputError>([&] {
                    (void)model_from_workspace(*workspace_, facs::builtin_catalogue(), test::expression("12"), mean,
                                               ModelOptions::thesis());
                }),
                words);
    EXPECT_NO_THROW(check_source(*workspace_, mean, {}));
    EXPECT_NO_THROW(check_source(*workspace_, {"bs000", {}}, ModelOptions::thesis()));
}

}  // namespace
}  // namespace mimik::modeling
