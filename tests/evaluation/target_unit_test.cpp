#include "evaluation/target_unit.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"
#include "tests/support/expressions.h"
#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<CaseRow> row_of(std::size_t t) {
    return {{{"", std::to_string(t), "12", "nothing"}, "field", "face", "left_out", 0, "vertices", ""}};
}

TEST(InOrder, takes_every_unit_once_in_order_though_an_early_one_is_slow) {
    base::set_thread_count(2);
    std::vector<std::size_t> taken;
    std::atomic<int> at_once = 0;
    in_order(
        40,
        [](std::size_t t) {
            if (t == 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
            return row_of(t);
        },
        [&](std::size_t t, const std::vector<CaseRow>& rows) {
            EXPECT_EQ(++at_once, 1);
            EXPECT_EQ(rows.front().key.target, std::to_string(t));
            taken.push_back(t);
            --at_once;
        });
    base::set_thread_count(0);
    ASSERT_EQ(taken.size(), 40U);
    for (std::size_t t = 0; t < taken.size(); ++t) EXPECT_EQ(taken[t], t);
}

TEST(InOrder, of_several_failing_units_the_first_is_told_whatever_the_threads) {
    for (const int threads : {1, 2, 4}) {
        base::set_thread_count(threads);
        std::atomic<std::size_t> last_taken = 0;
        EXPECT_EQ(test::message_of<InputError>([&] {
                      in_order(
                          40,
                          [](std::size_t t) {
                              if (t == 7) std::this_thread::sleep_for(std::chrono::milliseconds(20));
                              if (t >= 7) throw InputError("unit " + std::to_string(t));
                              return row_of(t);
                          },
                          [&](std::size_t t, const std::vector<CaseRow>&) { last_taken = t; });
                  }),
                  "unit 7")
            << threads;
        EXPECT_EQ(last_taken, 6U) << threads;
    }
    base::set_thread_count(0);
}

TEST(InOrder, begins_units_in_order_so_that_few_results_wait) {
    base::set_thread_count(1);
    std::vector<std::size_t> begun;
    std::size_t taken = 0, most_waiting = 0;
    in_order(
        40,
        [&](std::size_t t) {
            begun.push_back(t);
            most_waiting = std::max(most_waiting, begun.size() - taken);
            return row_of(t);
        },
        [&](std::size_t, const std::vector<CaseRow>&) { ++taken; });
    base::set_thread_count(0);
    for (std::size_t t = 0; t < begun.size(); ++t) EXPECT_EQ(begun[t], t);
    EXPECT_EQ(most_waiting, 1U);  // the one that is being scored
    EXPECT_EQ(taken, 40U);
}

TEST(InOrder, two_threads_begin_units_in_order_and_let_wait_only_what_was_finished_during_the_slow_one) {
    // Unit 3 ends when unit 8 has begun, and unit 8 when unit 3 was taken: 3 and the four between them are all that can
    // wait. Where only one thread is to be had, patience runs out and nothing waits.
    const std::size_t slow = 3, last = 8;
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    const auto until = [&](const std::atomic<bool>& happened) {
        while (!happened && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
    };
    std::atomic<bool> last_begun = false, slow_taken = false;
    std::mutex mutex;
    std::set<std::size_t> not_begun;
    for (std::size_t t = 0; t < 40; ++t) not_begun.insert(t);
    std::vector<std::size_t> taken;
    std::size_t finished = 0, most_waiting = 0;
    base::set_thread_count(2);
    in_order(
        40,
        [&](std::size_t t) {
            {
                const std::scoped_lock lock(mutex);
                not_begun.erase(t);
                // The other thread may have fetched an earlier unit and not come this far.
                EXPECT_LE(std::distance(not_begun.begin(), not_begun.lower_bound(t)), 1) << "before unit " << t;
            }
            if (t == last) last_begun = true;
            if (t == slow) until(last_begun);
            if (t == last) until(slow_taken);
            const std::scoped_lock lock(mutex);
            if (t < last) most_waiting = std::max(most_waiting, ++finished - taken.size());
            return row_of(t);
        },
        [&](std::size_t t, const std::vector<CaseRow>&) {
            const std::scoped_lock lock(mutex);
            taken.push_back(t);
            if (t == slow) slow_taken = true;
        });
    base::set_thread_count(0);
    EXPECT_LE(most_waiting, last - slow);
    ASSERT_EQ(taken.size(), 40U);
    for (std::size_t t = 0; t < taken.size(); ++t) EXPECT_EQ(taken[t], t);
}

TEST(InOrder, hands_on_what_the_first_failed_take_said_and_takes_nothing_after_it) {
    base::set_thread_count(2);
    std::atomic<int> taken = 0;
    EXPECT_EQ(test::message_of<InputError>([&] {
                  in_order(
                      40, [](std::size_t t) { return row_of(t); },
                      [&](std::size_t t, const std::vector<CaseRow>&) {
                          ++taken;
                          if (t == 3) throw InputError("disk full");
                      });
              }),
              "disk full");
    base::set_thread_count(0);
    EXPECT_EQ(taken, 4);
}

/// Moves every vertex by the same vector, learned from nobody.
class Push : public animation::Method {
public:
    Push(std::string name, const geometry::Vector& mm, animation::SourceKind needs)
        : name_(std::move(name)), mm_(mm), needs_(needs) {}
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] animation::SourceKind needs() const override { return needs_; }
    [[nodiscard]] std::unique_ptr<const animation::Learner> learner(const animation::LearningTask&) const override {
        return std::make_unique<PushLearner>(mm_);
    }

private:
    struct PushLesson : animation::Lesson {
        [[nodiscard]] std::size_t bytes() const override { return 0; }
    };
    struct PushTransfer : animation::Transfer {
        explicit PushTransfer(const geometry::Vector& by_mm) : mm(by_mm) {}
        [[nodiscard]] geometry::DisplacementField on(const animation::PreparedTarget& target) const override {
            if (!mm.allFinite()) throw NumericalError("pushed too far");
            auto field = geometry::DisplacementField::still(target.surface().size());
            for (auto& displacement : field.mm) displacement = mm;
            return field;
        }
        geometry::Vector mm;
    };
    struct PushLearner : animation::Learner {
        explicit PushLearner(const geometry::Vector& by_mm) : mm(by_mm) {}
        [[nodiscard]] animation::LessonPointer study(const modeling::Performance&) const override {
            return std::make_shared<PushLesson>();
        }
        [[nodiscard]] std::unique_ptr<const animation::Transfer> learn(
            std::span<const animation::LessonPointer>) const override {
            return std::make_unique<PushTransfer>(mm);
        }
        geometry::Vector mm;
    };
    std::string name_;
    geometry::Vector mm_;
    animation::SourceKind needs_;
};

using Methods = std::vector<animation::MethodPointer>;

/// Three subjects who smile, with a truth.
class ScoreTarget : public testing::Test {
protected:
    ScoreTarget() {
        test::write_analytic_truth(folder_.path() / "db");
        workspace_.emplace(test::analytic_workspace(folder_.path()));
        reader_.emplace(*workspace_);
    }
    [[nodiscard]] ExperimentPlan plan(const Methods& methods) const {
        ExperimentOptions options;
        options.expressions = {smile_};
        options.methods = methods;
        return plan_experiment(*workspace_, facs::builtin_catalogue(), options, true);
    }
    [[nodiscard]] Cast cast(const ExperimentPlan& plan) {
        return gather_cast(*reader_, {smile_, workspace_->average(), facs::builtin_catalogue()},
                           plan.expressions.front().performances, plan.methods, failures_);
    }
    /// The value of a case; NaN if there is no such row.
    static double value(const std::vector<CaseRow>& rows, const std::string& method, const std::string& source,
                        const std::string& estimator, const std::string& region, const std::string& metric) {
        for (const auto& row : rows)
            if (row.key.method == method && row.key.source == source && row.estimator == estimator &&
                row.region == region && row.metric == metric)
                return row.value.value();
        return std::numeric_limits<double>::quiet_NaN();
    }

    database::TemporaryFolder folder_;
    facs::Expression smile_ = test::expression("12");
    std::optional<preprocessing::Workspace> workspace_;
    std::optional<PerformanceReader> reader_;
    FailureList failures_;
};

TEST_F(ScoreTarget, a_method_of_ones_own_is_scored_beside_doing_nothing_in_the_order_of_the_plan) {
    const auto own = std::make_shared<Push>("own", geometry::Vector(0, 0, 5), animation::SourceKind::none);
    const auto planned = plan({own, animation::method_by_name("default"), animation::method_by_name("mean")});
    const auto gathered = cast(planned);
    const auto rows = score_target(*reader_, planned, gathered, 0, failures_);
    EXPECT_THAT(failures_.sorted(), testing::IsEmpty());
    std::vector<std::string> cases;
    for (const auto& row : rows) {
        const auto name = row.key.method + " " + row.key.source;
        if (cases.empty() || cases.back() != name) cases.push_back(name);
        EXPECT_EQ(row.key.target, "bs000");
        EXPECT_EQ(row.key.expression, "12");
    }
    EXPECT_THAT(cases, ElementsAre("nothing ", "own ", "default bs001", "default bs002", "mean mean",
                                   "true-field bs001", "true-field bs002", "true-field-mean mean"));
    // Pushed off the surface by 5 mm: hardly anything of it is nearer to the real scan.
    EXPECT_GT(value(rows, "own", "", "surface_distance", "zone", "mean"), 2);
    EXPECT_LT(value(rows, "true-field", "bs001", "true_distance", "zone", "mean"),
              0.3 * value(rows, "nothing", "", "true_distance", "zone", "mean"));
    EXPECT_GT(value(rows, "default", "bs001", "field", "face", "largest_step"), 0);
    EXPECT_TRUE(std::isnan(value(rows, "true-field", "bs001", "field", "face", "largest_step")));
}

TEST_F(ScoreTarget, a_case_whose_method_gives_no_answer_counts_as_doing_nothing_and_is_listed) {
    const geometry::Vector nowhere = geometry::Vector::Constant(std::numeric_limits<double>::quiet_NaN());
    const auto planned = plan({std::make_shared<Push>("lost", nowhere, animation::SourceKind::one_source),
                               std::make_shared<Push>("lost-mean", nowhere, animation::SourceKind::all_but_target)});
    const auto gathered = cast(planned);
    const auto rows = score_target(*reader_, planned, gathered, 0, failures_);
    for (const auto& [method, source] :
         {std::pair("lost", "bs001"), std::pair("lost", "bs002"), std::pair("lost-mean", "mean")}) {
        for (const auto& [estimator, region] :
             {std::pair("surface_distance", "zone"), std::pair("surface_distance", "face"),
              std::pair("true_distance", "zone")})
            EXPECT_EQ(value(rows, method, source, estimator, region, "mean"),
                      value(rows, "nothing", "", estimator, region, "mean"));
        EXPECT_TRUE(std::isnan(value(rows, method, source, "field", "face", "largest_step")));
    }
    for (const auto& row : rows)
        EXPECT_EQ(row.reason, row.key.method.starts_with("lost") ? "scored as doing nothing: pushed too far" : "");
    EXPECT_THAT(failures_.sorted(),
                ElementsAre(HasSubstr("bs001 -> bs000 by lost"), HasSubstr("bs002 -> bs000 by lost"),
                            HasSubstr("mean -> bs000 by lost-mean")));
}

/// Answers for one vertex, whatever the face.
class TooShort : public Push {
public:
    TooShort() : Push("too-short", geometry::Vector::Zero(), animation::SourceKind::none) {}
    [[nodiscard]] std::unique_ptr<const animation::Learner> learner(const animation::LearningTask&) const override {
        struct ShortTransfer : animation::Transfer {
            [[nodiscard]] geometry::DisplacementField on(const animation::PreparedTarget&) const override {
                return geometry::DisplacementField::still(1);
            }
        };
        struct ShortLearner : animation::Learner {
            [[nodiscard]] animation::LessonPointer study(const modeling::Performance&) const override {
                return nullptr;
            }
            [[nodiscard]] std::unique_ptr<const animation::Transfer> learn(
                std::span<const animation::LessonPointer>) const override {
                return std::make_unique<ShortTransfer>();
            }
        };
        return std::make_unique<ShortLearner>();
    }
};

TEST_F(ScoreTarget, a_field_of_another_surface_is_refused_by_the_name_of_its_method) {
    const auto planned = plan({std::make_shared<TooShort>()});
    const auto gathered = cast(planned);
    (void)score_target(*reader_, planned, gathered, 0, failures_);
    EXPECT_THAT(failures_.sorted(),
                ElementsAre(AllOf(HasSubstr("by too-short: "), HasSubstr("gave 1 displacement and 1 answer for"))));
}

TEST_F(ScoreTarget, a_target_whose_zone_sees_nothing_has_no_row_and_is_listed) {
    const auto planned = plan({animation::method_by_name("default")});
    auto gathered = cast(planned);
    gathered.zone.active.assign(gathered.zone.active.size(), 0);
    EXPECT_THAT(score_target(*reader_, planned, gathered, 0, failures_), testing::IsEmpty());
    EXPECT_THAT(failures_.sorted(), ElementsAre(HasSubstr("12: no case with target bs000: no vertex of the active")));
}

TEST_F(ScoreTarget, a_target_whose_truth_is_damaged_has_no_row_and_is_listed) {
    const auto planned = plan({animation::method_by_name("default")});
    const auto gathered = cast(planned);
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder_.path() / "db" / "truth"))
        if (file.path().filename().string().starts_with("bs000_LFAU_12_0")) std::filesystem::resize_file(file, 10);
    EXPECT_THAT(score_target(*reader_, planned, gathered, 0, failures_), testing::IsEmpty());
    EXPECT_THAT(failures_.sorted(), ElementsAre(HasSubstr("12: no case with target bs000")));
}

TEST(ScoreTargetWithoutTruth, a_scan_that_was_aligned_beside_its_neutral_is_no_target) {
    const database::TemporaryFolder folder;
    const auto workspace = test::analytic_workspace(folder.path());
    const auto smile = test::expression("12");
    auto smiling = workspace.face(*workspace.scan_of("bs001", smile));
    smiling.neutral_from_scan.pretranslate(geometry::Point(1000, 0, 0));
    preprocessing::write_face(workspace.stem(smiling.id), smiling);
    const PerformanceReader reader(workspace);
    ExperimentOptions options;
    options.expressions = {smile};
    options.methods = {animation::method_by_name("default")};
    const auto plan = plan_experiment(workspace, facs::builtin_catalogue(), options, false);
    FailureList failures;
    const auto cast = gather_cast(reader, {smile, workspace.average(), facs::builtin_catalogue()},
                                  plan.expressions.front().performances, plan.methods, failures);
    EXPECT_THAT(score_target(reader, plan, cast, 1, failures), testing::IsEmpty());
    EXPECT_THAT(failures.sorted(), testing::Contains(HasSubstr("no case with target bs001")));
}

}  // namespace
}  // namespace mimik::evaluation
