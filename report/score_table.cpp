#include "report/score_table.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "evaluation/reference_band.h"
#include "io/json_values.h"

namespace mimik::report {

using evaluation::ExperimentReport;
using evaluation::MethodScores;
using evaluation::ReferenceBand;
using evaluation::RowKind;

namespace {

std::string label(const std::string& expression) {
    const bool number = !expression.empty() && expression.front() >= '0' && expression.front() <= '9';
    return number ? "AU" + expression : expression;
}

const char* kind_name(RowKind kind) { return kind == RowKind::mean ? "mean" : "one source"; }

struct Pooled {
    std::size_t cases = 0, worse = 0;
};

Pooled pooled(const MethodScores& row) {
    Pooled total;
    for (const auto& [expression, score] : row.per_expression) {
        total.cases += score.cases;
        total.worse += score.worse_than_nothing;
    }
    return total;
}

bool tells_true_errors(const ExperimentReport& report) {
    return std::any_of(report.rows.begin(), report.rows.end(), [](const MethodScores& row) {
        return std::any_of(row.per_expression.begin(), row.per_expression.end(),
                           [](const auto& entry) { return entry.second.true_error_mm >= 0; });
    });
}

/// Whether every band that is known is met.
bool fit_to_be_scored_on(const std::vector<ReferenceBand>& bands) {
    return std::all_of(bands.begin(), bands.end(), [](const ReferenceBand& band) { return band.inside(); });
}

/// As many digits as it takes to see on which side of its limits it lies: 0.53004 is not inside 0.41 to 0.53.
std::string explained_text(const ReferenceBand& band) {
    constexpr int as_in_the_table = 3, all = 17;
    for (int digits = as_in_the_table; digits < all; ++digits) {
        auto text = fmt::format("{:.{}f}", band.explained, digits);
        auto as_shown = band;
        as_shown.explained = base::parse_double(text).value_or(band.explained);
        if (as_shown.inside() == band.inside()) return text;
    }
    return fmt::format("{}", band.explained);
}

std::string optional_number(double value) { return value < 0 ? "" : fmt::format("{:.6f}", value); }

}  // namespace

std::string to_markdown(const ExperimentReport& report) {
    std::string text = fmt::format(
        "Explained fraction: 1 - error / error of doing nothing, mean unsigned distance in the active zone to the real "
        "expressive scan ({} subjects, zones from the {}, alignment by {}).\n\n",
        report.subjects.size(), report.zones, report.alignment);
    text += "| method | kind |";
    std::string rule = "| --- | --- |";
    for (const auto& expression : report.expressions) {
        text += fmt::format(" {} |", label(expression));
        rule += " ---: |";
    }
    text += " mean | median case | share | whole face | worse than nothing |\n" + rule +
            " ---: | ---: | ---: | ---: | ---: |\n";
    for (const auto& row : report.rows) {
        text += fmt::format("| {} | {} |", row.reference ? "*" + row.method + "*" : row.method, kind_name(row.kind));
        for (const auto& expression : report.expressions)
            text += fmt::format(" {:.2f} |", row.per_expression.at(expression).explained);
        const auto total = pooled(row);
        text +=
            fmt::format(" **{:.3f}** | {:.3f} | {} | {} | {:.1f} % of {} |\n", row.explained, row.explained_median,
                        row.share ? fmt::format("{:.2f}", *row.share) : "",
                        report.whole_face ? fmt::format("{:.2f}", row.explained_whole) : "",
                        total.cases ? 100.0 * static_cast<double>(total.worse) / static_cast<double>(total.cases) : 0.0,
                        total.cases);
    }
    if (const auto bands = evaluation::reference_bands(report); !bands.empty()) {
        std::vector<std::string> words;
        words.reserve(bands.size());
        for (const auto& band : bands)
            words.push_back(fmt::format("{} {} (band {:.2f} to {:.2f})",
                                        band.kind == RowKind::mean ? "mean" : "from one source", explained_text(band),
                                        band.low, band.high));
        text += fmt::format("\nFit to be scored on: {}. True field {}.\n", fit_to_be_scored_on(bands) ? "yes" : "no",
                            fmt::join(words, ", "));
    }
    text += fmt::format("\nMean error in mm (distance to the real scan{}):\n\n| method | kind |",
                        tells_true_errors(report) ? " / to the true position of the same skin point" : "");
    for (const auto& expression : report.expressions) text += fmt::format(" {} |", label(expression));
    text += "\n| --- | --- |";
    for (std::size_t k = 0; k < report.expressions.size(); ++k) text += " ---: |";
    text += "\n| doing nothing | |";
    const auto cell = [](double surface_mm, double true_mm) {
        return true_mm < 0 ? fmt::format(" {:.2f} |", surface_mm)
                           : fmt::format(" {:.2f} / {:.2f} |", surface_mm, true_mm);
    };
    for (const auto& expression : report.expressions) {
        const auto& score = report.rows.front().per_expression.at(expression);
        text += cell(score.nothing_mm, score.nothing_true_mm);
    }
    text += "\n";
    for (const auto& row : report.rows) {
        text += fmt::format("| {} | {} |", row.reference ? "*" + row.method + "*" : row.method, kind_name(row.kind));
        for (const auto& expression : report.expressions) {
            const auto& score = row.per_expression.at(expression);
            text += cell(score.error_mm, score.true_error_mm);
        }
        text += "\n";
    }
    if (!report.failures.empty()) {
        text += fmt::format("\n{} failure(s); a case without an answer is scored as doing nothing:\n\n",
                            report.failures.size());
        for (const auto& failure : report.failures) text += "- " + failure + "\n";
    }
    return text;
}

std::string to_csv(const ExperimentReport& report) {
    std::string text =
        "method,kind,reference,expression,explained,explained_median,explained_whole_face,error_mm,nothing_mm,true_"
        "error_mm,"
        "nothing_true_mm,largest_step_mm,cases,worse_than_nothing,left_out_vertices\n";
    for (const auto& row : report.rows)
        for (const auto& expression : report.expressions) {
            const auto& s = row.per_expression.at(expression);
            text += fmt::format("\"{}\",{},{},{},{:.6f},{:.6f},{},{:.6f},{:.6f},{},{},{},{},{},{}\n", row.method,
                                kind_name(row.kind), row.reference ? 1 : 0, expression, s.explained, s.explained_median,
                                report.whole_face ? fmt::format("{:.6f}", s.explained_whole) : "", s.error_mm,
                                s.nothing_mm, optional_number(s.true_error_mm), optional_number(s.nothing_true_mm),
                                s.largest_step_mm ? fmt::format("{:.6f}", *s.largest_step_mm) : "", s.cases,
                                s.worse_than_nothing, s.left_out_vertices);
        }
    return text;
}

std::string to_json(const ExperimentReport& report) {
    const auto whole = [&](double value) { return report.whole_face ? nlohmann::json(value) : nlohmann::json(); };
    auto rows = nlohmann::json::array();
    for (const auto& row : report.rows) {
        nlohmann::json scores;
        for (const auto& [expression, s] : row.per_expression) {
            scores[expression] = {
                {"explained", s.explained},
                {"explained_median", s.explained_median},
                {"explained_whole_face", whole(s.explained_whole)},
                {"error_mm", s.error_mm},
                {"nothing_mm", s.nothing_mm},
                {"largest_step_mm", s.largest_step_mm ? nlohmann::json(*s.largest_step_mm) : nlohmann::json()},
                {"cases", s.cases},
                {"worse_than_nothing", s.worse_than_nothing},
                {"left_out_vertices", s.left_out_vertices}};
            const auto known = [](double value) { return value < 0 ? nlohmann::json() : nlohmann::json(value); };
            scores[expression]["true_error_mm"] = known(s.true_error_mm);
            scores[expression]["nothing_true_mm"] = known(s.nothing_true_mm);
        }
        rows.push_back({{"method", row.method},
                        {"kind", kind_name(row.kind)},
                        {"reference", row.reference},
                        {"explained", row.explained},
                        {"explained_median", row.explained_median},
                        {"explained_whole_face", whole(row.explained_whole)},
                        {"share", row.share ? nlohmann::json(*row.share) : nlohmann::json()},
                        {"expressions", scores}});
    }
    const auto known_bands = evaluation::reference_bands(report);
    auto bands = nlohmann::json::array();
    for (const auto& band : known_bands)
        bands.push_back({{"kind", kind_name(band.kind)},
                         {"explained", band.explained},
                         {"low", band.low},
                         {"high", band.high},
                         {"inside", band.inside()}});
    return io::json_text(nlohmann::json{
        {"schema", 1},
        {"subjects", report.subjects},
        {"expressions", report.expressions},
        {"zones", report.zones},
        {"alignment", report.alignment},
        {"truth", report.truth ? nlohmann::json{{"seed", report.truth->seed},
                                                {"face_model", report.truth->face_model},
                                                {"variances", report.truth->variances}}
                               : nlohmann::json()},
        {"reference_bands", bands},
        {"fit", known_bands.empty() ? nlohmann::json() : nlohmann::json(fit_to_be_scored_on(known_bands))},
        {"rows", rows},
        {"failures", report.failures}});
}

}  // namespace mimik::report
