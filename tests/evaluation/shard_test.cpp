#include "evaluation/shard.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "evaluation/case_store.h"
#include "evaluation/experiment.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"
#include "tests/support/expressions.h"

namespace mimik::evaluation {
namespace {

using database::message_of;
using testing::HasSubstr;

TEST(Shard, of_any_number_cut_the_units_without_gap_or_overlap_in_sizes_that_differ_by_one) {
    for (const std::size_t units : {0U, 1U, 7U, 945U})
        for (const std::size_t count : {1U, 2U, 7U, 20U}) {
            std::size_t next = 0;
            for (std::size_t k = 1; k <= count; ++k) {
                const auto range = Shard{k, count}.of(units);
                EXPECT_EQ(range.begin, next);
                EXPECT_GE(range.end - range.begin, units / count);
                EXPECT_LE(range.end - range.begin, units / count + 1);
                next = range.end;
            }
            EXPECT_EQ(next, units);
        }
}

TEST(Shard, is_read_as_it_is_written_and_nothing_else_is_one) {
    EXPECT_EQ(parse_shard("3/20"), (Shard{3, 20}));
    EXPECT_EQ(parse_shard("3/20").text(), "3/20");
    for (const auto* bad : {"", "3", "/", "3/", "/20", "0/20", "21/20", "3/20/1", "-1/20", "3/ 20", "1/100001", "a/b"})
        EXPECT_THAT(message_of<InputError>([&] { (void)parse_shard(bad); }), HasSubstr("give i/n")) << bad;
}

TEST(Shard, files_one_after_another_are_the_file_of_one_run) {
    const database::TemporaryFolder folder;
    test::write_analytic_truth(folder.path() / "db");
    const auto workspace = test::analytic_workspace(folder.path());
    ExperimentOptions options;
    options.expressions = {test::expression("12")};
    const auto catalogue = facs::builtin_catalogue();
    const PerformanceReader reader(workspace);
    const auto plan = plan_experiment(workspace, catalogue, options, true);
    const auto rows_of = [](const CaseStore& store) {
        std::string rows;
        store.read([&](const CaseRow& row) { rows += encode_case_row(row) + "\n"; });
        return rows;
    };
    CaseStore whole;
    const auto report = run_experiment(reader, catalogue, plan, whole);
    std::vector<std::filesystem::path> files;
    ASSERT_EQ(plan.units(), 3U);
    for (const std::size_t k : {1U, 2U}) {
        files.push_back(folder.path() / std::to_string(k));
        auto store = CaseStore::gone_on_with(files.back());
        std::vector<std::string> done;
        run_units(reader, catalogue, plan, Shard{k, 2}.of(plan.units()), store,
                  [&](const std::string& unit) { done.push_back(unit); });
        EXPECT_EQ(done.size(), k);        // 1 and 2 units
        EXPECT_EQ(store.units(), k + 1);  // and the cast
    }
    auto joined = CaseStore::of_files(files);
    EXPECT_EQ(joined.units(), 4U);  // the cast counts once
    EXPECT_EQ(rows_of(joined), rows_of(whole));
    const auto again = run_experiment(reader, catalogue, plan, joined);
    EXPECT_EQ(again.rows.at(1).explained, report.rows.at(1).explained);

    // One file short, it is not made up.
    auto short_of_one = CaseStore::of_files({files.front()});
    EXPECT_THAT(message_of<InputError>([&] { (void)run_experiment(reader, catalogue, plan, short_of_one); }),
                HasSubstr("unit '12 bs001' is in none of the files"));
}

TEST(Shard, stores_the_cast_of_an_expression_that_no_target_shows) {
    const database::TemporaryFolder folder;
    test::write_analytic_truth(folder.path() / "db");
    const auto workspace = test::analytic_workspace(folder.path());
    ExperimentOptions options;
    options.expressions = {test::expression("12")};
    const auto catalogue = facs::builtin_catalogue();
    const PerformanceReader reader(workspace);
    auto plan = plan_experiment(workspace, catalogue, options, true);
    plan.targets = {"nobody"};
    ASSERT_EQ(plan.units(), 0U);
    CaseStore store;
    run_units(reader, catalogue, plan, Shard{1, 1}.of(plan.units()), store);
    EXPECT_TRUE(store.has("12 cast"));
    EXPECT_EQ(store.units(), 1U);
}

TEST(Shard, that_was_stopped_within_an_expression_does_the_rest_alone) {
    const database::TemporaryFolder folder;
    test::write_analytic_truth(folder.path() / "db");
    const auto workspace = test::analytic_workspace(folder.path());
    ExperimentOptions options;
    options.expressions = {test::expression("12")};
    const auto catalogue = facs::builtin_catalogue();
    const PerformanceReader reader(workspace);
    const auto plan = plan_experiment(workspace, catalogue, options, true);
    const auto file = folder.path() / "rows";
    {
        auto store = CaseStore::gone_on_with(file);
        run_units(reader, catalogue, plan, {0, 3}, store);
    }
    const auto text = base::read_text(file);
    for (const auto cut : {text.find("# unit 12 bs000") + 5, text.find("# unit 12 bs001") - 20, text.size() - 3}) {
        base::write_atomically(file, text.substr(0, cut));
        auto store = CaseStore::gone_on_with(file);
        run_units(reader, catalogue, plan, {0, 3}, store);
        EXPECT_EQ(base::read_text(file), text) << cut;
    }
}

}  // namespace
}  // namespace mimik::evaluation
