#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

// [sample]
#include <fmt/format.h>

#include "evaluation/case_store.h"
#include "evaluation/comparison.h"

using namespace mimik;

/// What one line of a chapter needs, from the rows that `mimik evaluate -o DIR` left in DIR/cases.csv: by how much the
/// first method is truer than the second on each expression, and how sure that is.
std::vector<std::string> compared(const std::filesystem::path& cases, const std::string& first,
                                  const std::string& second) {
    const auto comparison = evaluation::compare_methods(
        [&](const auto& visit) { (void)evaluation::read_case_rows(cases, visit); }, {.seed = 1, .resamples = 2000});
    std::vector<std::string> lines;
    for (const auto& one : comparison.differences) {
        if (one.first != first || one.second != second) continue;
        auto line = fmt::format("AU {}: {:+.2f} {}", one.expression, one.difference, comparison.unit);
        if (one.interval) line += fmt::format(" [{:+.2f}, {:+.2f}]", one.interval->low, one.interval->high);
        lines.push_back(line + fmt::format(", p {:.3f}, q {:.3f}", one.p, one.q));
    }
    return lines;
}
// [end]

TEST(Samples, four_targets_that_gain_a_millimetre_are_no_chance_of_one_in_eight) {
    const test::TemporaryFolder folder;
    evaluation::CaseStore store(folder / "cases.csv");
    const auto row = [](const std::string& target, const char* method, double error_mm) {
        return evaluation::CaseRow{
            {"mean", target, "12", method}, "surface_distance", "zone", "mean", error_mm, "mm", ""};
    };
    for (const char* target : {"bs000", "bs001", "bs002", "bs003"})
        store.append(target, std::vector{row(target, "nothing", 3), row(target, "plain", 2), row(target, "mean", 1)});
    store.finish();
    // Two of 16 arrangements of signs are as far from 0.
    EXPECT_EQ(compared(folder / "cases.csv", "plain", "mean"),
              (std::vector<std::string>{"AU 12: +1.00 mm [+1.00, +1.00], p 0.125, q 0.125"}));
}
