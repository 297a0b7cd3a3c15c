#include "report/latex_tables.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace mimik::report {
namespace {

using evaluation::ExperimentReport;
using evaluation::MethodScores;

/// One column of numbers: what it says of a method, with how many digits, and whether more is better.
struct Column {
    std::string title;
    std::function<std::optional<double>(const MethodScores&)> value;
    int digits = 2;
};

std::string title_of(const facs::Expression& expression) {
    const auto& code = expression.code();
    return code.front() >= '0' && code.front() <= '9' ? "AU" + code : code;
}

/// A number with a mathematical minus; a dash where there is none.
std::string number_text(const std::optional<double>& value, int digits) {
    if (!value) return "--";
    const auto text = fmt::format("{:.{}f}", *value, digits);
    return text.front() == '-' ? "$-$" + text.substr(1) : text;
}

/// The best figure of a column among methods of one kind, as it is printed: equal print is equally bold.
std::string best_of(const ExperimentReport& report, const Column& column, animation::SourceKind kind,
                    bool more_is_better) {
    std::optional<double> best;
    for (const auto& row : report.rows) {
        if (row.reference || row.kind != kind) continue;
        const auto value = column.value(row);
        if (value && (!best || (more_is_better ? *value > *best : *value < *best))) best = value;
    }
    return best ? number_text(best, column.digits) : std::string();
}

std::string tabular(const ExperimentReport& report, const std::vector<Column>& columns, bool more_is_better,
                    const MethodScores* first_row) {
    std::string text =
        fmt::format("\\begin{{tabular}}{{ll{}}}\n\\toprule\nmethod & source", std::string(columns.size(), 'r'));
    for (const auto& column : columns) text += " & " + column.title;
    text += " \\\\\n\\midrule\n";
    const auto add = [&](const MethodScores& row, const std::string& kind) {
        const auto name = latex_text(row.method);
        text += fmt::format("{} & {}", row.reference ? "\\emph{" + name + "}" : name, latex_text(kind));
        for (const auto& column : columns) {
            const auto number = number_text(column.value(row), column.digits);
            const bool best = !row.reference && !kind.empty() && number != "--" &&
                              number == best_of(report, column, row.kind, more_is_better);
            text += best ? fmt::format(" & \\textbf{{{}}}", number) : " & " + number;
        }
        text += " \\\\\n";
    };
    if (first_row) add(*first_row, "");
    for (const bool reference : {false, true}) {
        if (reference && std::any_of(report.rows.begin(), report.rows.end(), [](const auto& r) { return r.reference; }))
            text += "\\midrule\n";
        for (const auto& row : report.rows)
            if (row.reference == reference) add(row, animation::to_string(row.kind));
    }
    return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace

std::string latex_text(const std::string& text) {
    static const std::map<char, std::string> special = {{'_', "\\_"},
                                                        {'%', "\\%"},
                                                        {'&', "\\&"},
                                                        {'#', "\\#"},
                                                        {'$', "\\$"},
                                                        {'{', "\\{"},
                                                        {'}', "\\}"},
                                                        {'~', "\\textasciitilde{}"},
                                                        {'^', "\\textasciicircum{}"},
                                                        {'\\', "\\textbackslash{}"}};
    std::string out;
    for (const char c : text) {
        const auto found = special.find(c);
        out += found == special.end() ? std::string(1, c) : found->second;
    }
    return out;
}

std::string explained_latex(const ExperimentReport& report) {
    std::vector<Column> columns;
    for (const auto& expression : report.expressions)
        columns.push_back({latex_text(title_of(expression)), [code = expression.code()](const MethodScores& row) {
                               return row.per_expression.at(code).explained;
                           }});
    columns.push_back({"mean", [](const MethodScores& row) { return row.explained; }, 3});
    columns.push_back({"share", [](const MethodScores& row) { return row.share; }});
    return "% explained fraction: 1 - error / error of doing nothing, zone of each expression; needs "
           "\\usepackage{booktabs}\n" +
           tabular(report, columns, true, nullptr);
}

std::string error_latex(const ExperimentReport& report) {
    std::vector<Column> columns;
    for (const auto& expression : report.expressions)
        columns.push_back({latex_text(title_of(expression)), [code = expression.code()](const MethodScores& row) {
                               return row.per_expression.at(code).error_mm;
                           }});
    return "% mean distance to the real expressive scan, mm, zone of each expression; needs \\usepackage{booktabs}\n" +
           tabular(report, columns, false, &report.nothing);
}

}  // namespace mimik::report
