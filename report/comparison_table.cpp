#include "report/comparison_table.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "animation/method.h"
#include "base/csv.h"
#include "evaluation/score.h"
#include "report/latex_tables.h"

namespace mimik::report {
namespace {

using evaluation::Comparison;
using evaluation::ComparisonOptions;
using evaluation::MethodDifference;
using evaluation::MethodSummary;

constexpr int csv_digits = 6;

std::string number(const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string();
}

std::string interval_text(const std::optional<statistics::Interval>& interval, int digits) {
    return interval ? fmt::format("{:.{}f} to {:.{}f}", interval->low, digits, interval->high, digits) : "too few";
}

/// "0.003", and no p that pretends to be nothing.
std::string chance_text(double p) { return p < 0.0005 ? "< 0.001" : fmt::format("{:.3f}", p); }

std::string shown_expression(const std::string& expression) {
    if (expression.empty()) return "all";
    return expression.front() >= '0' && expression.front() <= '9' ? "AU" + expression : expression;
}

/// Whether rows over all expressions are there: where there is one expression, its own row says it.
bool has_all(const Comparison& comparison) {
    return std::any_of(comparison.methods.begin(), comparison.methods.end(),
                       [](const MethodSummary& one) { return one.expression.empty(); });
}

/// The names in the order in which they first stand.
template <class Name>
std::vector<std::string> names_of(const Comparison& comparison, const std::string& region, const Name& name) {
    std::vector<std::string> names;
    for (const auto& one : comparison.methods)
        if (one.region == region && std::find(names.begin(), names.end(), name(one)) == names.end())
            names.push_back(name(one));
    return names;
}

const MethodSummary* find(const Comparison& comparison, const std::string& region, const std::string& expression,
                          const std::string& method) {
    for (const auto& one : comparison.methods)
        if (one.region == region && one.expression == expression && one.method == method) return &one;
    return nullptr;
}

std::string methods_table(const Comparison& comparison, const std::string& region, bool all) {
    std::string text = fmt::format(
        "| method | expression | cases | error, {0} | explained | interval |\n| --- | --- | ---: | ---: | ---: | --- "
        "|\n",
        comparison.unit);
    for (const auto& one : comparison.methods) {
        if (one.region != region || one.expression.empty() != all) continue;
        const bool nothing = one.method == evaluation::baseline_method;
        text += fmt::format("| {} | {} | {} | {:.3f} | {} | {} |\n", one.method, shown_expression(one.expression),
                            one.cases, one.error, number(one.explained, 3),
                            nothing ? "" : interval_text(one.explained_interval, 3));
    }
    return text;
}

/// Doing nothing and bounds: nobody chooses them.
bool is_anchor(const std::string& variant) {
    const auto name = variant.substr(0, variant.find('@'));
    const auto known = animation::known_methods();
    return name == evaluation::baseline_method || std::any_of(known.begin(), known.end(), [&](const auto& method) {
               return method->name() == name && method->needs_truth();
           });
}

/// What the tables of scores say already.
bool is_for_files_alone(const MethodDifference& one) { return is_anchor(one.first) || is_anchor(one.second); }

std::string differences_table(const Comparison& comparison, const std::string& region, bool all) {
    std::string text = fmt::format(
        "| first - second | expression | pairs | difference, {} | interval | dz | p | q |\n"
        "| --- | --- | ---: | ---: | --- | ---: | ---: | ---: |\n",
        comparison.unit);
    for (const auto& one : comparison.differences) {
        if (one.region != region || one.expression.empty() != all || is_for_files_alone(one)) continue;
        text += fmt::format("| {} - {} | {} | {} | {:.3f} | {} | {} | {} | {} |\n", one.first, one.second,
                            shown_expression(one.expression), one.pairs, one.difference, interval_text(one.interval, 3),
                            number(one.dz, 2), chance_text(one.p), chance_text(one.q));
    }
    return text;
}

}  // namespace

std::string to_markdown(const Comparison& comparison, const ComparisonOptions& options) {
    const bool all = has_all(comparison);
    std::string text = fmt::format(
        "How sure that is: intervals hold {:g} % (bootstrap of subjects, BCa, {} samples, seed {}); below 0 the first "
        "method is truer; dz is the mean difference of targets in standard deviations; p by sign flips over targets, q "
        "its false discovery rate (docs/algorithms/statistics.md).\n",
        100 * options.confidence, options.resamples, options.seed);
    for (const auto& region : options.regions) {
        if (options.regions.size() > 1) text += fmt::format("\nRegion `{}`:\n", region);
        text += "\n" + methods_table(comparison, region, all) + "\n" + differences_table(comparison, region, all);
    }
    text += "\nDifferences from doing nothing and from bounds, and those of every expression, are in `statistics/`.\n";
    return text;
}

std::string methods_csv(const Comparison& comparison) {
    std::string text = "region,expression,method,cases,targets,error,unit,explained,explained_low,explained_high\n";
    for (const auto& one : comparison.methods) {
        const auto& interval = one.explained_interval;
        text += fmt::format(
            "{},{},{},{},{},{},{},{},{},{}\n", one.region, base::csv_field(one.expression), base::csv_field(one.method),
            one.cases, one.targets, number(one.error, csv_digits), comparison.unit, number(one.explained, csv_digits),
            interval ? number(interval->low, csv_digits) : "", interval ? number(interval->high, csv_digits) : "");
    }
    return text;
}

std::string differences_csv(const Comparison& comparison) {
    std::string text = "region,expression,first,second,pairing,pairs,targets,difference,low,high,unit,dz,p,exact,q\n";
    for (const auto& one : comparison.differences) {
        const auto& interval = one.interval;
        text += fmt::format(
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", one.region, base::csv_field(one.expression),
            base::csv_field(one.first), base::csv_field(one.second), to_string(one.pairing), one.pairs, one.targets,
            number(one.difference, csv_digits), interval ? number(interval->low, csv_digits) : "",
            interval ? number(interval->high, csv_digits) : "", comparison.unit, number(one.dz, csv_digits),
            number(one.p, csv_digits), one.exact ? 1 : 0, number(one.q, csv_digits));
    }
    return text;
}

std::string intervals_latex(const Comparison& comparison, const ComparisonOptions& options) {
    const auto& region = options.regions.front();
    const auto expressions = names_of(comparison, region, [](const MethodSummary& one) { return one.expression; });
    const auto methods = names_of(comparison, region, [](const MethodSummary& one) { return one.method; });
    std::string text = fmt::format(
        "% explained fraction with its interval of {:g} \\%, region {}; needs \\usepackage{{booktabs}}\n"
        "\\begin{{tabular}}{{l{}}}\n\\toprule\nmethod",
        100 * options.confidence, latex_text(region), std::string(expressions.size(), 'r'));
    for (const auto& expression : expressions) text += " & " + latex_text(shown_expression(expression));
    text += " \\\\\n\\midrule\n";
    for (const auto& method : methods) {
        if (method == evaluation::baseline_method) continue;
        text += latex_text(method);
        for (const auto& expression : expressions) {
            const auto* own = find(comparison, region, expression, method);
            if (!own || !own->explained) {
                text += " & --";
                continue;
            }
            const bool best =
                !is_anchor(method) && std::none_of(methods.begin(), methods.end(), [&](const auto& other) {
                    const auto* theirs = is_anchor(other) ? nullptr : find(comparison, region, expression, other);
                    return theirs && theirs->explained && *theirs->explained > *own->explained;
                });
            const auto value = fmt::format("${}{:.2f}{}$", best ? "\\mathbf{" : "", *own->explained, best ? "}" : "");
            text += own->explained_interval ? fmt::format(" & {} {{\\scriptsize $[{:.2f}, {:.2f}]$}}", value,
                                                          own->explained_interval->low, own->explained_interval->high)
                                            : " & " + value;
        }
        text += " \\\\\n";
    }
    return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace mimik::report
