#include "report/experiment_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"

namespace mimik::report {
namespace {

using evaluation::CaseRow;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* evil = "</script><img src=x onerror=alert(1)>&\"'";

CaseRow zone_row(const std::string& source, const std::string& target, const std::string& method, double mm) {
    return {{source, target, "12", method, 1.0}, "surface_distance", "zone", "mean", mm, "mm", ""};
}

/// Three people; doing nothing is 2 mm off; one source explains 0.25 and 0.75 of each, the mean a half.
std::vector<CaseRow> rows() {
    std::vector<CaseRow> all;
    const std::vector<std::string> people = {"bs000", "bs001", evil};
    for (std::size_t t = 0; t < people.size(); ++t) {
        all.push_back(zone_row("", people[t], "nothing", 2.0));
        double error = 1.5;
        for (std::size_t s = 0; s < people.size(); ++s) {
            if (s == t) continue;
            all.push_back(zone_row(people[s], people[t], "default", error));
            error -= 1.0;
        }
        all.push_back(zone_row("mean", people[t], "mean", 1.0));
    }
    return all;
}

void read_rows(const std::function<void(const CaseRow&)>& visit) {
    for (const auto& row : rows()) visit(row);
}

json score_row(const std::string& method) {
    return {
        {"method", method}, {"share", nullptr}, {"expressions", {{"12", {{"cases", 6}, {"worse_than_nothing", 3}}}}}};
}

PageExperiment experiment() {
    PageExperiment one;
    one.title = evil;
    one.comparison.resamples = 200;  // of intervals, which no claim here is about
    one.scores = json{
        {"schema", 1},
        {"subjects", {"bs000", "bs001", evil}},
        {"expressions", {"12"}},
        {"zones", "data"},
        {"alignment", "ICP on the stable region"},
        {"truth", nullptr},
        {"anchors",
         {{{"method", "repeated-expression"},
           {"title", "performer floor"},
           {"mm", {{"12", nullptr}}},
           {"explained", {{"12", nullptr}}},
           {"targets", {{"12", 0}}},
           {"published_mm", {0.7, 1.1}},
           {"unknown", "nobody has a second scan"}}}},
        {"rows", {score_row("default"), score_row("mean")}},
        {"failures",
         {evil}}}.dump();
    one.identity = json{{"schema", 1}, {"mimik", "0.1.0"}, {"compiler", evil}}.dump();
    return one;
}

json data_of(const PageExperiment& one) { return json::parse(page_data(read_rows, one, facs::builtin_catalogue())); }

constexpr const char* small_page =
    "<title>{{title}}</title>{{#findings}}<li>{{text}}</li>{{/findings}}{{#anchors}}<p>{{text}}</p>{{/anchors}}"
    "{{#failures}}<li>{{text}}</li>{{/failures}}{{#provenance}}<td>{{value}}</td>{{/provenance}}"
    "<script type=\"application/json\">{{{data}}}</script><script type=\"application/json\">{{{faces}}}</script>";

TEST(ExperimentPage, numbers_are_those_of_the_rows) {
    const auto data = data_of(experiment());
    for (const auto& result : data.at("results")) {
        if (result.at("method") == "nothing") continue;
        // The mean error is 1 mm by either method, of 2 mm.
        EXPECT_EQ(result.at("error_mm"), 1.0) << result;
        EXPECT_EQ(result.at("explained"), 0.5) << result;
    }
    const auto& cases = data.at("cases");
    ASSERT_EQ(cases.at("rows").size(), 6U);  // three targets by two methods
    for (const auto& row : cases.at("rows")) {
        EXPECT_EQ(row[4], 1.0);
        EXPECT_EQ(row[5], 2.0);
        EXPECT_EQ(row[3], cases.at("methods")[row[2].get<std::size_t>()] == "default" ? 2 : 1);
    }
    for (const auto& method : data.at("methods"))
        if (method.at("name") == "mean") {
            EXPECT_EQ(method.at("worse_share"), 0.5);  // as scores.json has it: 3 of 6
        }
    EXPECT_EQ(data.at("expressions")[0].at("words"), "Lip Corner Puller");
}

TEST(ExperimentPage, the_same_rows_have_the_same_bytes) {
    const auto page = [] {
        const auto one = experiment();
        return experiment_page({small_page, "", ""}, one, page_data(read_rows, one, facs::builtin_catalogue()), "");
    };
    EXPECT_EQ(page(), page());
}

TEST(ExperimentPage, a_name_of_a_file_becomes_no_markup_and_ends_no_script) {
    const auto one = experiment();
    const auto text = page_data(read_rows, one, facs::builtin_catalogue());
    const auto page = experiment_page({small_page, "", ""}, one, text, json{{"target", evil}}.dump());
    EXPECT_THAT(page, Not(HasSubstr("<img")));
    EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;&lt;img"));
    std::size_t ends = 0;
    for (auto at = page.find("</script"); at != std::string::npos; at = page.find("</script", at + 1)) ++ends;
    EXPECT_EQ(ends, 2U);  // the template's own
    EXPECT_EQ(json::parse(json_for_script(text)), json::parse(text));
    EXPECT_EQ(json::parse(json_for_script(text)).at("title"), evil);
}

TEST(ExperimentPage, line_separators_of_javascript_and_broken_utf_8_do_no_harm) {
    EXPECT_EQ(json_for_script("\"a\xe2\x80\xa8\xe2\x80\xa9\xe2\x80\xa6\""), "\"a\\u2028\\u2029\xe2\x80\xa6\"");
    auto one = experiment();
    one.title = "thesis\xff";
    EXPECT_EQ(data_of(one).at("title"), "thesis\xef\xbf\xbd");
}

TEST(ExperimentPage, an_anchor_that_is_missing_is_said_to_be_with_the_reason) {
    const auto one = experiment();
    const auto page =
        experiment_page({small_page, "", ""}, one, page_data(read_rows, one, facs::builtin_catalogue()), "");
    EXPECT_THAT(page, HasSubstr("The performer floor is unknown: nobody has a second scan. Published: 0.7 to 1.1 mm"));
    EXPECT_THAT(page, HasSubstr("The true field is unknown: the database has no truth."));
    EXPECT_THAT(page, HasSubstr("default explains 0.50 of the motion"));
}

TEST(ExperimentPage, of_more_cases_than_it_holds_the_worst_and_the_best_stay_and_the_rest_is_counted) {
    auto one = experiment();
    one.most_cases = 4;
    const auto cases = data_of(one).at("cases");
    EXPECT_EQ(cases.at("rows").size(), 4U);
    EXPECT_EQ(cases.at("left_out"), 2);
}

TEST(ExperimentPage, parts_that_would_end_the_page_early_are_refused) {
    const auto one = experiment();
    const auto text = page_data(read_rows, one, facs::builtin_catalogue());
    EXPECT_THROW((void)experiment_page({small_page, "", "a = '</SCRIPT>'"}, one, text, ""), InputError);
    EXPECT_THROW((void)experiment_page({"{{#open}}", "", ""}, one, text, ""), InputError);
    EXPECT_THROW((void)read_page_parts("/nowhere"), InputError);
}

}  // namespace
}  // namespace mimik::report
