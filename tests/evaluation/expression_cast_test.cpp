#include "evaluation/expression_cast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"

namespace mimik::evaluation {
namespace {

using geometry::Vector;
using testing::ElementsAre;

class Cast : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new database::TemporaryFolder;
        test::write_analytic_truth(folder_->path() / "db");
        workspace_ = new preprocessing::Workspace(test::analytic_workspace(folder_->path()));
    }
    static void TearDownTestSuite() {
        delete workspace_;
        delete folder_;
    }
    static database::ScanId smile(int subject) {
        return *workspace_->expression("bs00" + std::to_string(subject), "12");
    }
    static database::TemporaryFolder* folder_;
    static preprocessing::Workspace* workspace_;
};

database::TemporaryFolder* Cast::folder_ = nullptr;
preprocessing::Workspace* Cast::workspace_ = nullptr;

TEST(ModelsShared, are_those_of_methods_that_model_alike) {
    const std::vector<Method> methods = {method_by_name("thesis"), method_by_name("default"), method_by_name("mean")};
    EXPECT_THAT(models_shared_by(methods), ElementsAre(0U, 1U, 1U));
}

TEST_F(Cast, a_true_field_read_again_is_the_one_that_was_held) {
    const PerformanceReader reader(*workspace_);
    const auto field = reader.true_field_mm(smile(0));
    EXPECT_EQ(field, reader.read(smile(0)).true_expression->displacement_mm);
    // The analytic neutral has no micro-expression: its true smile is the closed form's.
    EXPECT_EQ(field, test::analytic_truth("bs000_LFAU_12_0", {test::analytic_scales[0], test::analytic_smile_mm},
                                          test::analytic_pose(1))
                         .displacement_mm);
    TrueFields roomy(reader), narrow(reader, field.size() * sizeof(Vector));  // room for one
    for (auto* fields : {&roomy, &narrow})
        for (int k = 0; k < 3; ++k) fields->add(smile(k), reader.true_field_mm(smile(k)));
    EXPECT_EQ(roomy.held(), 3U);
    EXPECT_EQ(narrow.held(), 1U);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(*roomy.of(k), *narrow.of(k)) << k;
}

TEST_F(Cast, of_more_than_one_batch_is_in_the_order_of_the_scans) {
    const PerformanceReader reader(*workspace_);
    const std::vector<Method> methods = {method_by_name("default"), method_by_name("mean")};
    std::vector<database::ScanId> scans;
    for (int k = 0; k < 20; ++k) scans.push_back(smile(k % 3));
    FailureList failures;
    const auto cast = gather_cast(reader, modeling::builtin_catalogue(), "12", scans, methods, true, failures);
    EXPECT_TRUE(failures.sorted().empty());
    ASSERT_EQ(cast.participants.size(), scans.size());
    EXPECT_EQ(cast.true_fields.held(), scans.size());
    for (std::size_t k = 0; k < scans.size(); ++k) {
        EXPECT_EQ(cast.participants[k].id, scans[k]);
        EXPECT_EQ(*cast.true_fields.of(k), reader.true_field_mm(scans[k]));
        ASSERT_TRUE(cast.participants[k].models[0]);
        EXPECT_EQ(cast.participants[k].models[0]->sources.back(), scans[k].name());
        EXPECT_FALSE(cast.participants[k].models[1]);  // shared with the first
    }
}

TEST_F(Cast, without_true_fields_wanted_holds_none) {
    FailureList failures;
    const PerformanceReader reader(*workspace_);
    const std::vector<database::ScanId> scans = {smile(0), smile(1)};
    EXPECT_EQ(gather_cast(reader, modeling::builtin_catalogue(), "12", scans, {}, false, failures).true_fields.held(),
              0U);
}

}  // namespace
}  // namespace mimik::evaluation
