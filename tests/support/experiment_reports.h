#pragma once

#include <tuple>

#include "evaluation/experiment.h"

namespace mimik::test {

/// The nine expressions by a method and by the true fields of `sources` sources on 12 targets.
inline evaluation::ExperimentReport report_of(double one, double mean, std::size_t sources) {
    evaluation::ExperimentReport report;
    report.expressions = evaluation::ExperimentOptions::thesis_expressions();
    report.truth = evaluation::TruthOrigin{
        7, "some face model", "12,12L", 5, 2, true, {{"identity", 0.8}}, {{"marking_jitter", 0.5}}};
    for (const auto& [kind, explained, reference] : {std::tuple(animation::SourceKind::one_source, 0.3, false),
                                                     std::tuple(animation::SourceKind::one_source, one, true),
                                                     std::tuple(animation::SourceKind::all_but_target, mean, true)}) {
        evaluation::MethodScores row;
        row.method = reference ? "true field" : "default";
        row.kind = kind;
        row.reference = row.bound = reference;
        row.explained = explained;
        for (const auto& expression : report.expressions)
            row.per_expression[expression.code()].cases =
                kind == animation::SourceKind::all_but_target ? 12 : 12 * sources;
        report.rows.push_back(row);
    }
    report.nothing = report.rows.front();
    return report;
}

}  // namespace mimik::test
