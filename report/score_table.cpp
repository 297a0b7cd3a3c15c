#include "report/score_table.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "io/json_values.h"

namespace mimik::report {
namespace {

/// "AU12L" for "12L"; words as they are.
std::string label(const facs::Expression& expression) {
    const auto& code = expression.code();
    return code.front() >= '0' && code.front() <= '9' ? "AU" + code : code;
}

std::string kind_name(const evaluation::MethodScores& row, bool on_itself) {
    return on_itself && row.kind == animation::SourceKind::one_source ? "itself" : animation::to_string(row.kind);
}

struct Pooled {
    std::size_t cases = 0, worse = 0;
};

Pooled pooled(const evaluation::MethodScores& row) {
    Pooled total;
    for (const auto& [expression, score] : row.per_expression) {
        total.cases += score.cases;
        total.worse += score.worse_than_nothing;
    }
    return total;
}

/// "4.2 % of 1188"; empty without a case.
std::string worse_text(const Pooled& total) {
    if (total.cases == 0) return {};
    return fmt::format("{:.1f} % of {}", 100.0 * static_cast<double>(total.worse) / static_cast<double>(total.cases),
                       total.cases);
}

std::string text_of(const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string();
}

nlohmann::json json_of(const std::optional<double>& value) { return value ? nlohmann::json(*value) : nlohmann::json(); }

/// "| method | kind | AU1 | ... |" and the rule below it.
std::string header_of(const evaluation::ExperimentReport& report, const std::vector<std::string>& more) {
    std::string text = "| method | kind |", rule = "| --- | --- |";
    for (const auto& expression : report.expressions) {
        text += fmt::format(" {} |", label(expression));
        rule += " ---: |";
    }
    for (const auto& column : more) {
        text += fmt::format(" {} |", column);
        rule += " ---: |";
    }
    return text + "\n" + rule + "\n";
}

std::string begin_row(const evaluation::ExperimentReport& report, const evaluation::MethodScores& row) {
    return fmt::format("| {} | {} |", row.reference ? "*" + row.method + "*" : row.method,
                       kind_name(row, report.on_itself));
}

/// Mean over the targets of one expression; empty: not known.
std::optional<double> floor_mm(const evaluation::Anchor& anchor, const facs::Expression& expression) {
    const auto found = anchor.mm.find(expression.code());
    return found == anchor.mm.end() ? std::nullopt : std::optional(found->second);
}

/// What a face that is off by the floor alone explains.
std::optional<double> explained_by_floor(const evaluation::ExperimentReport& report, const evaluation::Anchor& anchor,
                                         const facs::Expression& expression) {
    const auto mm = floor_mm(anchor, expression);
    const auto found = report.nothing.per_expression.find(expression.code());
    if (!mm || found == report.nothing.per_expression.end()) return std::nullopt;
    const auto& nothing_mm = found->second.nothing_mm;
    if (!nothing_mm || *nothing_mm <= evaluation::least_motion_mm) return std::nullopt;
    return 1 - *mm / *nothing_mm;
}

/// A line per anchor; what is not known says so.
template <class Number>
std::string anchor_rows(const evaluation::ExperimentReport& report, std::size_t more_columns, const Number& number) {
    std::string text;
    for (const auto& anchor : report.anchors) {
        text += fmt::format("| {} | anchor |", anchor.title);
        double sum = 0;
        std::size_t known = 0;
        for (const auto& expression : report.expressions) {
            const std::optional<double> value = number(anchor, expression);
            text += fmt::format(" {} |", value ? text_of(value, 2) : "unknown");
            sum += value.value_or(0);
            known += value ? 1 : 0;
        }
        for (std::size_t k = 0; k < more_columns; ++k)
            text += k == 0 && known > 0 ? fmt::format(" {:.3f} |", sum / static_cast<double>(known)) : "  |";
        text += "\n";
    }
    return text;
}

/// What the anchors are, and why one is not known: a figure without them says little.
std::string about_anchors(const evaluation::ExperimentReport& report) {
    std::string text =
        "\nAnchors: doing nothing is 0 and a perfect face 1. The scanner floor is what a second scan of the same "
        "resting "
        "face is off by, the performer floor a second scan of the same expression.\n";
    for (const auto& anchor : report.anchors) {
        if (anchor.unknown.empty()) continue;
        text += fmt::format("The {} is unknown: {}.", anchor.title, anchor.unknown);
        if (anchor.method == evaluation::performer_floor)
            text += fmt::format(" Published: {} to {} mm (Johnston et al. 2003).",
                                evaluation::published_performer_floor_mm.first,
                                evaluation::published_performer_floor_mm.second);
        text += "\n";
    }
    const bool any = std::any_of(report.rows.begin(), report.rows.end(), [](const auto& row) { return row.bound; });
    if (!any)
        text += fmt::format("The true-field reference is unknown: {}.\n",
                            report.truth ? "it was left out" : "the database has no truth");
    return text;
}

std::string explained_table(const evaluation::ExperimentReport& report) {
    std::string text = header_of(report, {"mean", "median case", "share", "whole face", "worse than nothing"});
    for (const auto& row : report.rows) {
        text += begin_row(report, row);
        for (const auto& expression : report.expressions)
            text += fmt::format(" {} |", text_of(row.per_expression.at(expression.code()).explained, 2));
        const auto total = pooled(row);
        text += fmt::format(" {} | {} | {} | {} | {} |\n",
                            row.explained ? fmt::format("**{:.3f}**", *row.explained) : std::string(),
                            text_of(row.explained_median, 3), text_of(row.share, 2), text_of(row.explained_whole, 2),
                            worse_text(total));
    }
    constexpr std::size_t columns_behind = 5;
    text += anchor_rows(report, columns_behind, [&](const auto& anchor, const auto& expression) {
        return explained_by_floor(report, anchor, expression);
    });
    return text + about_anchors(report);
}

/// Distances in millimetres; with a truth two of them.
std::string error_cell(const std::optional<double>& surface_mm, const std::optional<double>& true_mm) {
    if (!surface_mm) return "  |";
    return true_mm ? fmt::format(" {:.2f} / {:.2f} |", *surface_mm, *true_mm) : fmt::format(" {:.2f} |", *surface_mm);
}

std::string error_table(const evaluation::ExperimentReport& report) {
    const auto& nothing = report.nothing.per_expression;
    const bool true_errors = std::any_of(nothing.begin(), nothing.end(),
                                         [](const auto& entry) { return entry.second.true_error_mm.has_value(); });
    std::string text = fmt::format("Mean error in mm (distance to the real scan{}):\n\n",
                                   true_errors ? " / to the true position of the same skin point" : "");
    text += header_of(report, {}) + "| doing nothing | |";
    for (const auto& expression : report.expressions) {
        const auto& score = nothing.at(expression.code());
        text += error_cell(score.error_mm, score.true_error_mm);
    }
    text += "\n";
    for (const auto& row : report.rows) {
        text += begin_row(report, row);
        for (const auto& expression : report.expressions) {
            const auto& score = row.per_expression.at(expression.code());
            text += error_cell(score.error_mm, score.true_error_mm);
        }
        text += "\n";
    }
    return text + anchor_rows(report, 0, floor_mm);
}

/// "1.4 (AU27 9.8)": the mean over the expressions, and the worst of them where there are several.
std::string lip_text(const evaluation::ExperimentReport& report, const evaluation::MethodScores& row) {
    constexpr int digits = 1;  // landmarks are marked to about 1 mm
    std::string worst;
    double worst_mm = -1;
    for (const auto& expression : report.expressions) {
        const auto& mm = row.per_expression.at(expression.code()).faults.lip_aperture_error_mm;
        if (!mm || *mm <= worst_mm) continue;
        worst_mm = *mm;
        worst = fmt::format(" ({} {:.{}f})", label(expression), worst_mm, digits);
    }
    return text_of(row.faults.lip_aperture_error_mm, digits) + (report.expressions.size() > 1 ? worst : "");
}

std::string faults_table(const evaluation::ExperimentReport& report) {
    std::string text =
        "What the distance does not see (means over the expressions; of the lips the worst one, too):\n\n"
        "| method | kind | lips apart: median error, mm | still skin moves by, mm | peak / true peak | "
        "lip vertices over a hole | all vertices over a hole |\n"
        "| --- | --- | ---: | ---: | ---: | ---: | ---: |\n";
    const auto add = [&](const std::string& begin, const evaluation::MethodScores& row) {
        const auto& faults = row.faults;
        text += fmt::format("{} {} | {} | {} | {} | {} |\n", begin, lip_text(report, row),
                            text_of(faults.still_skin_mm, 2), text_of(faults.peak_ratio, 2),
                            text_of(faults.lips_over_hole, 1), text_of(faults.face_over_hole, 1));
    };
    add("| doing nothing | |", report.nothing);
    for (const auto& row : report.rows) add(begin_row(report, row), row);
    return text +
           "\nThe anchors of these figures are doing nothing and the true fields; their floors are unknown, "
           "since a second scan is no moved face.\n";
}

void add_to(nlohmann::json& document, const evaluation::Faults& faults) {
    evaluation::Faults::each_field(
        faults, [&](const char* name, const std::optional<double>& value) { document[name] = json_of(value); });
}

nlohmann::json json_of(const evaluation::Score& s) {
    nlohmann::json document = {{"explained", json_of(s.explained)},
                               {"explained_median", json_of(s.explained_median)},
                               {"explained_whole_face", json_of(s.explained_whole)},
                               {"error_mm", json_of(s.error_mm)},
                               {"nothing_mm", json_of(s.nothing_mm)},
                               {"true_error_mm", json_of(s.true_error_mm)},
                               {"nothing_true_mm", json_of(s.nothing_true_mm)},
                               {"largest_step_mm", json_of(s.largest_step_mm)},
                               {"cases", s.cases},
                               {"worse_than_nothing", s.worse_than_nothing},
                               {"left_out_vertices", s.left_out_vertices}};
    add_to(document, s.faults);
    return document;
}

nlohmann::json json_of(const evaluation::MethodScores& row, bool on_itself) {
    nlohmann::json scores;
    for (const auto& [expression, score] : row.per_expression) scores[expression] = json_of(score);
    nlohmann::json document = {{"method", row.method},
                               {"kind", kind_name(row, on_itself)},
                               {"reference", row.reference},
                               {"explained", json_of(row.explained)},
                               {"explained_median", json_of(row.explained_median)},
                               {"explained_whole_face", json_of(row.explained_whole)},
                               {"share", json_of(row.share)},
                               {"expressions", scores}};
    add_to(document, row.faults);
    return document;
}

nlohmann::json json_of(const evaluation::ExperimentReport& report, const evaluation::Anchor& anchor) {
    nlohmann::json mm = nlohmann::json::object(), explained = nlohmann::json::object(),
                   targets = nlohmann::json::object();
    for (const auto& expression : report.expressions) {
        mm[expression.code()] = json_of(floor_mm(anchor, expression));
        explained[expression.code()] = json_of(explained_by_floor(report, anchor, expression));
        const auto found = anchor.targets.find(expression.code());
        targets[expression.code()] = found == anchor.targets.end() ? std::size_t{0} : found->second;
    }
    nlohmann::json document = {{"method", anchor.method},
                               {"title", anchor.title},
                               {"mm", mm},
                               {"explained", explained},
                               {"targets", targets},
                               {"unknown", anchor.unknown.empty() ? nlohmann::json() : nlohmann::json(anchor.unknown)}};
    if (anchor.method == evaluation::performer_floor)
        document["published_mm"] = {evaluation::published_performer_floor_mm.first,
                                    evaluation::published_performer_floor_mm.second};
    return document;
}

}  // namespace

std::string to_markdown(const evaluation::ExperimentReport& report) {
    std::string text = report.on_itself ? "Each source on itself: how well a model says what it was made from, and no "
                                          "figure of one person on another.\n\n"
                                        : "";
    text += fmt::format(
        "Explained fraction: 1 - error / error of doing nothing, mean unsigned distance in the active zone to the real "
        "expressive scan ({} subjects, zones from the {}{}, alignment by {}).\n\n",
        report.subjects.size(), report.zones,
        report.zones_by_catalogue.empty()
            ? std::string()
            : fmt::format(" (of {} from the catalogue)", fmt::join(report.zones_by_catalogue, ", ")),
        report.alignment);
    text += explained_table(report) + "\n" + error_table(report) + "\n" + faults_table(report);
    if (report.failures.empty()) return text;
    text += fmt::format("\n{}; a case without an answer is scored as doing nothing:\n\n",
                        base::counted(report.failures.size(), "failure"));
    for (const auto& failure : report.failures) text += "- " + failure + "\n";
    return text;
}

std::string to_csv(const evaluation::ExperimentReport& report) {
    std::string text =
        "method,kind,reference,expression,explained,explained_median,explained_whole_face,error_mm,nothing_mm,true_"
        "error_mm,nothing_true_mm,largest_step_mm,cases,worse_than_nothing,left_out_vertices";
    const evaluation::Faults names;
    evaluation::Faults::each_field(names, [&](const char* name, const auto&) { text += fmt::format(",{}", name); });
    for (const auto& anchor : report.anchors) text += fmt::format(",{}_mm", anchor.method);
    text += "\n";
    constexpr int digits = 6;
    for (const auto& row : report.rows)
        for (const auto& expression : report.expressions) {
            const auto& s = row.per_expression.at(expression.code());
            text += fmt::format(
                "\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{}", row.method, kind_name(row, report.on_itself),
                row.reference ? 1 : 0, expression.code(), text_of(s.explained, digits),
                text_of(s.explained_median, digits), text_of(s.explained_whole, digits), text_of(s.error_mm, digits),
                text_of(s.nothing_mm, digits), text_of(s.true_error_mm, digits), text_of(s.nothing_true_mm, digits),
                text_of(s.largest_step_mm, digits), s.cases, s.worse_than_nothing, s.left_out_vertices);
            evaluation::Faults::each_field(s.faults, [&](const char*, const std::optional<double>& value) {
                text += "," + text_of(value, digits);
            });
            for (const auto& anchor : report.anchors) text += "," + text_of(floor_mm(anchor, expression), digits);
            text += "\n";
        }
    return text;
}

std::string to_json(const evaluation::ExperimentReport& report) {
    auto rows = nlohmann::json::array();
    for (const auto& row : report.rows) rows.push_back(json_of(row, report.on_itself));
    auto anchors = nlohmann::json::array();
    for (const auto& anchor : report.anchors) anchors.push_back(json_of(report, anchor));
    std::vector<std::string> expressions;
    for (const auto& expression : report.expressions) expressions.push_back(expression.code());
    nlohmann::json document =
        nlohmann::json{{"schema", 1},
                       {"subjects", report.subjects},
                       {"expressions", expressions},
                       {"zones", report.zones},
                       {"zones_by_catalogue", report.zones_by_catalogue},
                       {"alignment", report.alignment},
                       {"truth", report.truth ? nlohmann::json{{"seed", report.truth->seed},
                                                               {"face_model", report.truth->face_model},
                                                               {"subjects", report.truth->subjects},
                                                               {"expressions", report.truth->expressions},
                                                               {"neutrals", report.truth->neutrals},
                                                               {"repeat", report.truth->repeat},
                                                               {"variances", report.truth->variances},
                                                               {"scanner", report.truth->scanner}}
                                              : nlohmann::json()},
                       {"anchors", anchors},
                       {"rows", rows},
                       {"failures", report.failures}};
    if (report.on_itself) document["pairs"] = "source on itself";
    return io::json_text(document);
}

}  // namespace mimik::report
