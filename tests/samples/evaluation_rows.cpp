#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

// [sample]
#include "evaluation/case_store.h"
#include "evaluation/score.h"

using namespace mimik;

/// What a method explained of an expression, from the rows that `mimik evaluate -o DIR` left in DIR/cases.csv.
std::optional<double> explained_in(const std::filesystem::path& cases, const std::string& method,
                                   const std::string& expression) {
    const auto table =
        evaluation::scores_of([&](const auto& visit) { (void)evaluation::read_case_rows(cases, visit); });
    const auto found = table.find(method);
    if (found == table.end() || !found->second.contains(expression)) return std::nullopt;
    return found->second.at(expression).explained;
}
// [end]

TEST(Samples, half_the_error_of_doing_nothing_is_half_explained) {
    const test::TemporaryFolder folder;
    evaluation::CaseStore store(folder / "cases.csv");
    const auto row = [](const char* source, const char* method, double error_mm) {
        return evaluation::CaseRow{
            {source, "bs000", "12", method}, "surface_distance", "zone", "mean", error_mm, "mm", ""};
    };
    store.append("12 bs000",
                 std::vector{row("", "nothing", 2.0), row("bs001", "default", 0.8), row("bs002", "default", 1.2)});
    store.finish();
    EXPECT_DOUBLE_EQ(explained_in(folder / "cases.csv", "default", "12").value(), 0.5);
    EXPECT_FALSE(explained_in(folder / "cases.csv", "default", "4").has_value());
}
