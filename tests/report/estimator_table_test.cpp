#include "report/estimator_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/estimator_choice.h"

namespace mimik::report {
namespace {

using testing::HasSubstr;

TEST(EstimatorTables, hold_every_estimator_with_unit_and_definition) {
    const auto markdown = estimators_markdown();
    const auto document = nlohmann::json::parse(estimators_json());
    ASSERT_EQ(document.at("estimators").size(), evaluation::estimator_definitions().size());
    for (const auto& one : document.at("estimators")) {
        EXPECT_THAT(markdown, HasSubstr("| `" + one.at("name").get<std::string>() + "` | " +
                                        one.at("unit").get<std::string>() + " | "));
        EXPECT_FALSE(one.at("definition").get<std::string>().empty());
    }
    EXPECT_THAT(markdown, HasSubstr("| `point-to-surface` | mm | \\|p - q\\|, p a vertex"));  // bars end no cell
    EXPECT_THAT(markdown, HasSubstr("Regions: zone, face, "));
    EXPECT_EQ(document.at("alignments").size(), 4U);
}

TEST(EstimatorTables, of_a_check_leave_blank_what_is_not_known) {
    evaluation::EstimatorCheck check;
    check.agreements.push_back({"12", "default", "signed", "zone", "mean_absolute", 2, {}, {}, {}, 0.5, 1.5});
    check.summaries.push_back({"default", "signed", "zone", 1, 20, 0.912, 0.95, 0.9, 0.91, 0.7, "12"});
    EXPECT_THAT(to_csv(check), HasSubstr("signed,default,12,zone,mean_absolute,2,,,,0.500000,1.500000\n"));
    EXPECT_THAT(to_markdown(check), HasSubstr("| signed | default | 1 | 20 | 0.91 (12) | 0.95 | 0.90 | 0.91 | 0.70 |"));
    EXPECT_THAT(to_markdown(check), HasSubstr("| signed | default | 12 | 2 |  |  |  | 0.50 | 1.50 |"));
}

}  // namespace
}  // namespace mimik::report
