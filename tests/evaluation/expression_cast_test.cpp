#include "evaluation/expression_cast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
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
    const auto cast = gather_cast(reader, facs::builtin_catalogue(), "12", scans, methods, true, failures);
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

/// Three subjects whose HAPPY is the smile of their left half alone: AU12 moves both halves, nobody shows AU6.
TEST(CastOfEmotion, has_the_zones_of_its_units_beside_its_own) {
    const database::TemporaryFolder folder;
    const auto db = folder.path() / "db";
    test::write_analytic_truth(db);
    auto document = nlohmann::json::parse(base::read_text(db / "truth" / "truth.json"));
    for (int k = 0; k < 3; ++k) {
        const auto name = "bs00" + std::to_string(k) + "_E_HAPPY_0";
        const test::AnalyticFace shape{test::analytic_scales[k], test::analytic_smile_mm};
        test::write_analytic_scan(db, name, shape, test::analytic_pose(k));
        auto truth = test::analytic_truth(name, shape, test::analytic_pose(k));
        for (std::size_t v = 0; v < truth.vertices_mm.size(); ++v)
            if ((truth.scanner_from_head.inverse() * truth.vertices_mm[v]).x() < 0) truth.displacement_mm[v].setZero();
        database::write_true_scan(db / "truth", truth);
        document["scans"].push_back(name);
    }
    base::write_atomically(db / "truth" / "truth.json", document.dump());
    const auto workspace = test::analytic_workspace(folder.path());
    const PerformanceReader reader(workspace);
    FailureList failures;
    const auto zone_of = [&](const std::string& expression) {
        std::vector<database::ScanId> scans;
        for (const auto& subject : workspace.subjects()) scans.push_back(*workspace.expression(subject, expression));
        return gather_cast(reader, facs::builtin_catalogue(), expression, scans, {}, false, failures).zone.active;
    };
    const auto happy = zone_of("HAPPY"), smile = zone_of("12");
    const auto& average = workspace.average();
    const auto cheeks = active_zone_from_catalogue("6", average, facs::builtin_catalogue()).active;
    ASSERT_EQ(happy.size(), smile.size());
    std::size_t only_smile = 0, only_cheeks = 0;
    for (std::size_t v = 0; v < happy.size(); ++v) {
        EXPECT_EQ(happy[v] != 0, smile[v] != 0 || cheeks[v] != 0) << v;  // its own zone lies inside that of AU12
        if (!happy[v]) continue;
        if (!cheeks[v] && average.grid.vertices_mm[v].x() < -5) ++only_smile;
        if (!smile[v]) ++only_cheeks;
    }
    EXPECT_GT(only_smile, 20U);  // a corner's bump is 24 mm wide, the grid's cells 2 to 3 mm
    EXPECT_GT(only_cheeks, 20U);
    EXPECT_TRUE(failures.sorted().empty());
}

TEST_F(Cast, without_true_fields_wanted_holds_none) {
    FailureList failures;
    const PerformanceReader reader(*workspace_);
    const std::vector<database::ScanId> scans = {smile(0), smile(1)};
    EXPECT_EQ(gather_cast(reader, facs::builtin_catalogue(), "12", scans, {}, false, failures).true_fields.held(), 0U);
}

}  // namespace
}  // namespace mimik::evaluation
