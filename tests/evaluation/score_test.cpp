#include "evaluation/score.h"

#include <gtest/gtest.h>

namespace mimik::evaluation {
namespace {

/// Rows of one case: zone, whole face, true distance, step.
struct Case {
    std::string method, source;
    double zone_mm = 0;
    std::optional<double> face_mm = {}, true_mm = {}, step_mm = {};
};

Score score_of(const std::vector<Case>& cases, const std::string& method) {
    std::vector<CaseRow> rows;
    for (const auto& one : cases) {
        const CaseKey key{one.source, "bs000", "12", one.method};
        rows.push_back({key, "surface_distance", "zone", "mean", one.zone_mm, "mm", ""});
        if (one.face_mm) rows.push_back({key, "surface_distance", "face", "mean", one.face_mm, "mm", ""});
        if (one.true_mm) rows.push_back({key, "true_distance", "zone", "mean", one.true_mm, "mm", ""});
        if (one.step_mm) rows.push_back({key, "field", "face", "largest_step", one.step_mm, "mm", ""});
        rows.push_back({key, "field", "face", "left_out", 3, "vertices", ""});
    }
    const auto table = scores_of([&](const auto& visit) {
        for (const auto& row : rows) visit(row);
    });
    return table.at(method).at("12");
}

TEST(Score, of_an_oracle_is_one_and_sums_over_cases_come_before_the_quotient) {
    EXPECT_EQ(score_of({{"nothing", "", 2}, {"own", "bs001", 0}}, "own").explained, 1);
    EXPECT_EQ(score_of({{"nothing", "", 2}, {"own", "bs001", 1}}, "own").explained, 0.5);
    const auto score = score_of({{"nothing", "", 2}, {"own", "bs001", 0}, {"own", "bs002", 1}}, "own");
    EXPECT_EQ(score.explained, 0.75);
    EXPECT_EQ(score.cases, 2U);
    EXPECT_EQ(score.error_mm, 0.5);
    EXPECT_EQ(score.nothing_mm, 2);
    EXPECT_EQ(score.left_out_vertices, 6U);
}

TEST(Score, knows_no_case_whose_baseline_is_another_face) {
    const CaseKey nothing{"", "bs000", "12", "nothing"}, own{"bs001", "bs000", "12", "own"};
    const CaseKey stranger{"bs001", "bs002", "12", "own"};
    const auto table = scores_of([&](const auto& visit) {
        for (const auto& [key, mm] : {std::pair(nothing, 2.0), std::pair(own, 1.0), std::pair(stranger, 8.0)})
            visit({key, "surface_distance", "zone", "mean", mm, "mm", ""});
    });
    EXPECT_EQ(table.at("own").at("12").cases, 1U);
    EXPECT_EQ(table.at("own").at("12").explained, 0.5);
}

TEST(Score, of_a_source_on_itself_stands_in_no_mean_of_pairs_and_of_pairs_in_none_of_itself) {
    const CaseKey nothing{"", "bs000", "12", "nothing"}, other{"bs001", "bs000", "12", "own"};
    const CaseKey itself{"bs000", "bs000", "12", "own"};
    const auto read = [&](const auto& visit) {
        for (const auto& [key, mm] : {std::pair(nothing, 2.0), std::pair(itself, 0.5), std::pair(other, 1.0)})
            visit({key, "surface_distance", "zone", "mean", mm, "mm", ""});
    };
    const auto pairs = scores_of(read), alone = scores_of(read, Pairs::source_on_itself);
    EXPECT_EQ(pairs.at("own").at("12").cases, 1U);
    EXPECT_EQ(pairs.at("own").at("12").explained, 0.5);
    EXPECT_EQ(alone.at("own").at("12").cases, 1U);
    EXPECT_EQ(alone.at("own").at("12").explained, 0.75);
    EXPECT_EQ(alone.at("nothing").at("12").explained, 0.0);
}

TEST(Score, of_overshooting_is_negative_and_counted_as_worse_than_nothing) {
    const auto score = score_of({{"nothing", "", 2}, {"own", "bs001", 4}, {"own", "bs002", 2}}, "own");
    EXPECT_EQ(score.worse_than_nothing, 1U);
    EXPECT_EQ(score.explained, 1 - 6.0 / 4.0);
    EXPECT_EQ(score.explained_median, -0.5);
}

TEST(Score, of_an_expressive_scan_that_equals_its_neutral_is_unknown) {
    const auto still = score_of({{"nothing", "", 2.5e-14, 3e-14}, {"own", "bs001", 2, 1}}, "own");
    EXPECT_EQ(still.explained, std::nullopt);
    EXPECT_EQ(still.explained_median, std::nullopt);
    EXPECT_EQ(still.explained_whole, std::nullopt);
    EXPECT_EQ(still.error_mm, 2);
}

TEST(Score, of_the_whole_face_and_of_true_distances_is_told_where_it_is_known) {
    const auto known = score_of({{"nothing", "", 2, 4, 3}, {"own", "bs001", 1, 3, 1.5}}, "own");
    EXPECT_EQ(known.explained_whole, 0.25);
    EXPECT_EQ(known.true_error_mm, 1.5);
    EXPECT_EQ(known.nothing_true_mm, 3);
    const auto unknown = score_of({{"nothing", "", 2}, {"own", "bs001", 1}}, "own");
    EXPECT_EQ(unknown.explained_whole, std::nullopt);
    EXPECT_EQ(unknown.true_error_mm, std::nullopt);
}

TEST(Score, takes_the_mean_step_over_the_cases_that_have_one) {
    const std::vector<Case> cases = {
        {"nothing", "", 2}, {"own", "bs001", 1, {}, {}, 1}, {"own", "bs002", 1}, {"own", "bs003", 1, {}, {}, 4}};
    EXPECT_EQ(score_of(cases, "own").largest_step_mm, 2.5);
    EXPECT_EQ(score_of(cases, "nothing").largest_step_mm, std::nullopt);
}

TEST(Score, is_not_known_where_doing_nothing_is_not_off) {
    const auto score = score_of({{"nothing", "", 0}, {"own", "bs001", 1}}, "own");
    EXPECT_EQ(score.explained, std::nullopt);
    EXPECT_EQ(score.error_mm, 1);
}

/// Faults of three cases: rows that say nothing of one are not zeros.
TEST(Score, of_faults_is_told_of_the_cases_that_know_them) {
    std::vector<CaseRow> rows;
    const auto add = [&](const std::string& method, const std::string& source, std::optional<double> lip_error_mm,
                         double still_mm, double peak_mm, std::optional<double> true_peak_mm, double over_hole) {
        const CaseKey key{source, "bs000", "27", method};
        rows.push_back({key, "surface_distance", "zone", "mean", 1, "mm", ""});
        if (lip_error_mm) rows.push_back({key, "lip_aperture", "mouth", "error", lip_error_mm, "mm", ""});
        rows.push_back({key, "lip_aperture", "mouth", "real", 99, "mm", ""});
        rows.push_back({key, "still_skin", "face", "mean", still_mm, "mm", ""});
        rows.push_back({key, "peak", "zone", "animated", peak_mm, "mm", ""});
        if (true_peak_mm) rows.push_back({key, "peak", "zone", "true", true_peak_mm, "mm", ""});
        rows.push_back({key, "over_hole", "face", "vertices", over_hole, "vertices", ""});
        rows.push_back({key, "over_hole", "mouth", "vertices", 0, "vertices", ""});
    };
    add("nothing", "", -8, 0, 0, 10, 300);
    add("own", "bs001", -5, 0.1, 6, 10, 40);
    add("own", "bs002", 1, 0.2, 9, 10, 10);
    add("own", "bs003", std::nullopt, 0.6, 100, std::nullopt, 10);
    const auto table = scores_of([&](const auto& visit) {
        for (const auto& row : rows) visit(row);
    });
    const auto& own = table.at("own").at("27").faults;
    EXPECT_EQ(own.lip_aperture_error_mm, 3);  // of 5 and 1
    EXPECT_DOUBLE_EQ(*own.still_skin_mm, 0.3);
    EXPECT_EQ(own.peak_ratio, 0.75);
    EXPECT_EQ(own.lips_over_hole, 0);
    EXPECT_EQ(own.face_over_hole, 20);
    EXPECT_EQ(table.at("nothing").at("27").faults.lip_aperture_error_mm, 8);
    EXPECT_EQ(table.at("nothing").at("27").faults.peak_ratio, 0);
    EXPECT_EQ(score_of({{"nothing", "", 2}, {"own", "bs001", 1}}, "own").faults, Faults());
}

TEST(Score, compares_each_target_with_its_own_doing_nothing) {
    std::vector<CaseRow> rows;
    for (const auto& [target, nothing_mm, own_mm] : {std::tuple("bs000", 2.0, 1.0), std::tuple("bs001", 4.0, 1.0)}) {
        rows.push_back({{"", target, "12", "nothing"}, "surface_distance", "zone", "mean", nothing_mm, "mm", ""});
        rows.push_back({{"bs002", target, "12", "own"}, "surface_distance", "zone", "mean", own_mm, "mm", ""});
    }
    const auto table = scores_of([&](const auto& visit) {
        for (const auto& row : rows) visit(row);
    });
    EXPECT_EQ(table.at("own").at("12").explained, 1 - 2.0 / 6.0);
    EXPECT_EQ(table.at("own").at("12").explained_median, 0.5 * (0.5 + 0.75));
}

}  // namespace
}  // namespace mimik::evaluation
