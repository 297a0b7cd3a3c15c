#include "report/latex_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/expressions.h"

namespace mimik::report {
namespace {

using animation::SourceKind;
using testing::HasSubstr;
using testing::Not;

evaluation::MethodScores scores(const std::string& method, SourceKind kind, std::optional<double> explained,
                                std::optional<double> error_mm, bool reference = false) {
    evaluation::MethodScores row;
    row.method = method;
    row.kind = kind;
    row.reference = reference;
    row.per_expression["12"].explained = explained;
    row.per_expression["12"].error_mm = error_mm;
    row.explained = explained;
    return row;
}

evaluation::ExperimentReport three_methods() {
    evaluation::ExperimentReport report;
    report.expressions = {test::expression("12")};
    report.nothing = scores("doing nothing", SourceKind::none, 0.0, 1.25);
    report.rows = {scores("thesis_1", SourceKind::one_source, -0.284, 1.6),
                   scores("default", SourceKind::one_source, 0.421, 0.7),
                   scores("true field", SourceKind::one_source, 0.48, 0.6, true),
                   scores("mean", SourceKind::all_but_target, std::nullopt, std::nullopt)};
    return report;
}

TEST(LatexTables, the_best_method_of_a_kind_is_bold_and_a_bound_never_is) {
    const auto text = explained_latex(three_methods());
    EXPECT_THAT(text, HasSubstr("method & source & AU12 & mean & share \\\\\n\\midrule\n"));
    EXPECT_THAT(text, HasSubstr("thesis\\_1 & one source & $-$0.28 & $-$0.284 & -- \\\\\n"));
    EXPECT_THAT(text, HasSubstr("default & one source & \\textbf{0.42} & \\textbf{0.421} & -- \\\\\n"));
    EXPECT_THAT(text, HasSubstr("mean & mean & -- & -- & -- \\\\\n\\midrule\n\\emph{true field} & one source & 0.48 "));
    EXPECT_THAT(text, testing::EndsWith("\\bottomrule\n\\end{tabular}\n"));
}

TEST(LatexTables, of_errors_the_smallest_is_best_and_doing_nothing_comes_first) {
    const auto text = error_latex(three_methods());
    EXPECT_THAT(text, HasSubstr("\\midrule\ndoing nothing &  & 1.25 \\\\\nthesis\\_1 & one source & 1.60 \\\\\n"));
    EXPECT_THAT(text, HasSubstr("default & one source & \\textbf{0.70} \\\\\n"));
    EXPECT_THAT(text, Not(HasSubstr("\\textbf{0.60}")));
}

TEST(LatexTables, no_name_can_break_a_document) {
    EXPECT_EQ(latex_text("a_b%c&d#e$f{g}h~i^j\\k"),
              "a\\_b\\%c\\&d\\#e\\$f\\{g\\}h\\textasciitilde{}i\\textasciicircum{}j\\textbackslash{}k");
}

}  // namespace
}  // namespace mimik::report
