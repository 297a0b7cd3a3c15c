#include "evaluation/cast.h"

#include <algorithm>
#include <atomic>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "animation/model_method.h"
#include "base/errors.h"
#include "base/file.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"
#include "tests/support/expressions.h"

namespace mimik::evaluation {
namespace {

class CastTest : public testing::Test {
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
        return *workspace_->scan_of("bs00" + std::to_string(subject), test::expression("12"));
    }
    static database::TemporaryFolder* folder_;
    static preprocessing::Workspace* workspace_;
};

database::TemporaryFolder* CastTest::folder_ = nullptr;
preprocessing::Workspace* CastTest::workspace_ = nullptr;

/// Keeps the true motion alone, and counts how often it is asked for.
class CountingLearner : public animation::Learner {
public:
    explicit CountingLearner(std::atomic<int>& studied) : studied_(studied) {}
    [[nodiscard]] animation::LessonPointer study(const modeling::Performance& performance) const override {
        ++studied_;
        return true_field_->study(performance);
    }
    [[nodiscard]] std::unique_ptr<const animation::Transfer> learn(
        std::span<const animation::LessonPointer> lessons) const override {
        return true_field_->learn(lessons);
    }

private:
    std::atomic<int>& studied_;
    std::unique_ptr<const animation::Learner> true_field_ =
        animation::method_by_name("true-field")->learner({smile_expression, average, facs::builtin_catalogue()});
    static inline const facs::Expression smile_expression = test::expression("12");
    static inline const preprocessing::AverageFace average = {};
};

class CountingMethod : public animation::Method {
public:
    CountingMethod(std::string name, std::atomic<int>& studied) : name_(std::move(name)), studied_(studied) {}
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] animation::SourceKind needs() const override { return animation::SourceKind::one_source; }
    [[nodiscard]] std::string lessons_key() const override { return "counted"; }
    [[nodiscard]] std::unique_ptr<const animation::Learner> learner(const animation::LearningTask&) const override {
        return std::make_unique<CountingLearner>(studied_);
    }

private:
    std::string name_;
    std::atomic<int>& studied_;
};

TEST_F(CastTest, methods_that_take_the_same_lessons_share_them_and_what_is_not_held_is_studied_again) {
    const PerformanceReader reader(*workspace_);
    std::atomic<int> studied = 0;
    const std::vector<animation::MethodPointer> methods = {std::make_shared<CountingMethod>("one", studied),
                                                           std::make_shared<CountingMethod>("other", studied)};
    FailureList failures;
    const auto smile_expression = test::expression("12");
    const animation::LearningTask task{smile_expression, workspace_->average(), facs::builtin_catalogue()};
    LessonBook roomy(reader, task, methods, failures);
    const auto lesson_bytes = roomy.study(reader.read(smile(0))).front()->bytes();
    LessonBook narrow(reader, task, methods, failures, lesson_bytes);  // room for one
    studied = 0;
    for (auto* book : {&roomy, &narrow})
        for (int k = 0; k < 3; ++k) book->add(smile(k), book->study(reader.read(smile(k))));
    EXPECT_EQ(studied, 6);  // once for both methods
    EXPECT_EQ(roomy.held(), 3U);
    EXPECT_EQ(narrow.held(), 1U);
    EXPECT_EQ(roomy.lesson(0, 2), roomy.lesson(1, 2));
    studied = 0;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(narrow.lesson(0, k)->bytes(), roomy.lesson(0, k)->bytes()) << k;
    EXPECT_EQ(studied, 2);
}

TEST_F(CastTest, methods_that_share_lessons_still_make_their_own_of_them) {
    const PerformanceReader reader(*workspace_);
    animation::ModelMethod::Setting plain;
    plain.name = "plain";
    plain.model = modeling::ModelOptions::sparse();
    auto thin_plate = plain;
    thin_plate.name = "thin-plate";
    thin_plate.animation.kernel = geometry::SplineKernel::r2_log_r2;
    const std::vector<animation::MethodPointer> methods = {std::make_shared<animation::ModelMethod>(plain),
                                                           std::make_shared<animation::ModelMethod>(thin_plate)};
    FailureList failures;
    const auto expression = test::expression("12");
    const animation::LearningTask task{expression, workspace_->average(), facs::builtin_catalogue()};
    LessonBook book(reader, task, methods, failures);
    book.add(smile(0), book.study(reader.read(smile(0))));
    ASSERT_EQ(book.lesson(0, 0), book.lesson(1, 0));
    const animation::PreparedTarget target(reader.read(smile(1)).neutral);
    const auto field_by = [&](std::size_t method) {
        return book.learner(method).learn(std::vector{book.lesson(method, 0)})->on(target).mm;
    };
    EXPECT_EQ(field_by(0), animation::learn(*methods[0], task, std::vector{reader.read(smile(0))})->on(target).mm);
    EXPECT_EQ(field_by(1), animation::learn(*methods[1], task, std::vector{reader.read(smile(0))})->on(target).mm);
    EXPECT_NE(field_by(0), field_by(1));
}

TEST_F(CastTest, the_true_smile_of_the_analytic_faces_is_that_of_the_closed_form) {
    // The analytic neutral has no micro-expression.
    EXPECT_EQ(PerformanceReader(*workspace_).read(smile(0)).true_expression->displacement_mm,
              test::analytic_truth("bs000_LFAU_12_0", {test::analytic_scales[0], test::analytic_smile_mm},
                                   test::analytic_pose(1))
                  .displacement_mm);
}

TEST_F(CastTest, of_more_than_one_batch_is_in_the_order_of_the_scans) {
    const PerformanceReader reader(*workspace_);
    const std::vector methods = {animation::method_by_name("default"), animation::method_by_name("mean")};
    std::vector<database::ScanId> scans;
    for (int k = 0; k < 20; ++k) scans.push_back(smile(k % 3));
    FailureList failures;
    const auto smile_expression = test::expression("12");
    const auto cast = gather_cast(reader, {smile_expression, workspace_->average(), facs::builtin_catalogue()}, scans,
                                  methods, failures);
    EXPECT_TRUE(failures.sorted().empty());
    EXPECT_EQ(cast.participants, scans);
    EXPECT_EQ(cast.lessons.held(), scans.size());
    for (std::size_t k = 0; k < scans.size(); ++k) {
        ASSERT_TRUE(cast.lessons.lesson(0, k));
        EXPECT_EQ(cast.lessons.lesson(0, k), cast.lessons.lesson(1, k));  // shared with the first
    }
}

TEST_F(CastTest, the_zone_of_the_data_is_where_the_truth_moves_most_and_not_where_it_holds_still) {
    const PerformanceReader reader(*workspace_);
    const auto expression = test::expression("12");
    const animation::LearningTask task{expression, workspace_->average(), facs::builtin_catalogue()};
    FailureList failures;
    const std::vector scans = {smile(0), smile(1), smile(2)};
    const auto of = [&](ZoneSource source) { return gather_cast(reader, task, scans, {}, failures, source); };
    const auto truth = of(ZoneSource::truth), data = of(ZoneSource::data), drawn = of(ZoneSource::catalogue);
    EXPECT_EQ(data.zone_from, ZoneSource::data);
    EXPECT_EQ(drawn.zone_from, ZoneSource::catalogue);
    EXPECT_EQ(of(ZoneSource::automatic).zone.active, truth.zone.active);
    EXPECT_EQ(drawn.zone.active, shipped_active_zone(expression, workspace_->average()).active);
    const auto& true_mm = truth.zone.displacement_mm;
    const double largest_mm = *std::max_element(true_mm.begin(), true_mm.end());
    std::size_t active = 0;
    for (std::size_t v = 0; v < true_mm.size(); ++v) {
        active += data.zone.active[v] ? 1 : 0;
        // Along the smooth cheek the scans show only part of the motion: half of it is far above the share of 0.2, and
        // where nothing moves what registration invents stays far below.
        if (true_mm[v] > 0.5 * largest_mm) {
            EXPECT_TRUE(data.zone.active[v]) << workspace_->average().grid.vertices_mm[v].transpose();
        }
        if (workspace_->average().grid.vertices_mm[v].y() > 20) {
            EXPECT_FALSE(data.zone.active[v]) << workspace_->average().grid.vertices_mm[v].transpose();
        }
    }
    EXPECT_GT(active, 100U);
    EXPECT_TRUE(data.remarks.empty());
    EXPECT_TRUE(failures.sorted().empty());
}

/// AU 17 of people without a truth is a smile of 0.5 mm.
TEST(CastWithoutTruth, takes_the_zone_of_the_catalogue_with_a_remark_where_the_scans_show_next_to_nothing) {
    const database::TemporaryFolder folder;
    for (int k = 0; k < 3; ++k)
        test::write_analytic_scan(folder.path() / "db", "bs00" + std::to_string(k) + "_LFAU_17_0",
                                  {test::analytic_scales[k], 0.5}, test::analytic_pose(k));
    const auto workspace = test::analytic_workspace(folder.path());
    const PerformanceReader reader(workspace);
    FailureList failures;
    const auto cast_of = [&](const char* code, ZoneSource source) {
        const auto expression = test::expression(code);
        std::vector<database::ScanId> scans;
        for (const auto& subject : workspace.subjects()) scans.push_back(*workspace.scan_of(subject, expression));
        return gather_cast(reader, {expression, workspace.average(), facs::builtin_catalogue()}, scans, {}, failures,
                           source);
    };
    const auto small = cast_of("17", ZoneSource::automatic);
    EXPECT_EQ(small.zone_from, ZoneSource::catalogue);
    EXPECT_EQ(small.zone.active, shipped_active_zone(test::expression("17"), workspace.average()).active);
    EXPECT_THAT(
        small.remarks,
        testing::ElementsAre(testing::StartsWith("17: zone from the catalogue, the scans show a mean motion of")));
    EXPECT_EQ(cast_of("12", ZoneSource::automatic).zone_from, ZoneSource::data);
    EXPECT_THROW((void)cast_of("12", ZoneSource::truth), InputError);
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
    const auto zone_of = [&](const std::string& text) {
        const auto expression = test::expression(text);
        std::vector<database::ScanId> scans;
        for (const auto& subject : workspace.subjects()) scans.push_back(*workspace.scan_of(subject, expression));
        return gather_cast(reader, {expression, workspace.average(), facs::builtin_catalogue()}, scans, {}, failures)
            .zone.active;
    };
    const auto happy = zone_of("HAPPY"), smile = zone_of("12");
    const auto& average = workspace.average();
    const auto cheeks = shipped_active_zone(test::expression("6"), average).active;
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

}  // namespace
}  // namespace mimik::evaluation
