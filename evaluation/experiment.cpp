#include "evaluation/experiment.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "evaluation/expression_cast.h"
#include "evaluation/performance.h"
#include "evaluation/target_cases.h"

namespace mimik::evaluation {

using database::ScanId;
using preprocessing::Workspace;

namespace {

std::vector<std::string> shown_subjects(const Workspace& workspace) {
    std::vector<std::string> subjects;
    for (const auto& subject : workspace.subjects())
        if (!workspace.hidden(subject)) subjects.push_back(subject);
    return subjects;
}

/// The scans of one expression, one per subject that shows it.
std::vector<ScanId> scans_of(const Workspace& workspace, const std::vector<std::string>& subjects,
                             const std::string& expression) {
    std::vector<ScanId> scans;
    for (const auto& subject : subjects)
        if (auto id = workspace.expression(subject, expression)) scans.push_back(std::move(*id));
    return scans;
}

}  // namespace

void ExperimentOptions::check() const {
    if (methods.empty()) throw InputError("an experiment without a method; give one or more of thesis, default, mean");
    if (expressions.empty())
        throw InputError("an experiment without an expression; give one or more, such as 12 or HAPPY");
    for (std::size_t k = 0; k < expressions.size(); ++k)
        if (std::find(expressions.begin(), expressions.begin() + static_cast<std::ptrdiff_t>(k), expressions[k]) !=
            expressions.begin() + static_cast<std::ptrdiff_t>(k))
            throw InputError(
                fmt::format("expression '{}' is asked for twice; its cases would count twice", expressions[k]));
    if (max_sources < 0) throw InputError(fmt::format("max_sources is {}; give 0 (all) or more", max_sources));
    for (const auto& method : methods) {
        method.model.check();
        method.animation.check();
    }
}

void check_experiment(const Workspace& workspace, const facs::FacsCatalogue& catalogue,
                      const ExperimentOptions& options) {
    options.check();
    const auto subjects = shown_subjects(workspace);
    for (const auto& expression : options.expressions) {
        (void)catalogue.resolve(expression);
        const auto shown = scans_of(workspace, subjects, expression).size();
        if (shown < 3)
            throw InputError(fmt::format("{}: expression '{}': {} subjects show it; an experiment needs three or more",
                                         workspace.root().string(), expression, shown));
    }
    (void)PerformanceReader(workspace);
}

ExperimentEstimate estimate_experiment(const Workspace& workspace, const ExperimentOptions& options) {
    // Processor time on an AMD EPYC at 2.6 GHz: 14 subjects of ICT-FaceKit, 150 x 150 vertices, AU 1, 12 and 17.
    constexpr double subject_s = 0.06;    // read three times, measured, made ready as a target
    constexpr double transfer_s = 0.009;  // 7 ms by the default, 11 by thesis, 9 of a true field, whole face included
    const bool truth = PerformanceReader(workspace).has_truth();
    ExperimentEstimate estimate;
    for (const auto& expression : options.expressions) {
        const std::size_t subjects = scans_of(workspace, shown_subjects(workspace), expression).size();
        if (subjects == 0) continue;
        const auto limit = static_cast<std::size_t>(options.max_sources);
        const std::size_t sources = limit > 0 ? std::min(limit, subjects - 1) : subjects - 1;
        std::size_t per_target = options.reference && truth ? sources + 1 : 0;
        for (const auto& method : options.methods) per_target += method.kind == RowKind::mean ? 1 : sources;
        estimate.transfers += subjects * per_target;
        estimate.core_seconds += static_cast<double>(subjects) * subject_s;
    }
    estimate.core_seconds += static_cast<double>(estimate.transfers) * transfer_s;
    return estimate;
}

std::size_t experiment_steps(const Workspace& workspace, const ExperimentOptions& options) {
    std::size_t steps = 0;
    for (const auto& code : options.expressions) steps += scans_of(workspace, shown_subjects(workspace), code).size();
    return steps;
}

namespace {

/// One run: what its expressions share, and the report that they fill.
class ExperimentRun {
public:
    ExperimentRun(const Workspace& workspace, const facs::FacsCatalogue& catalogue, const ExperimentOptions& options,
                  const std::function<void(const std::string&)>& progress)
        : workspace_(workspace), catalogue_(catalogue), options_(options), progress_(progress), reader_(workspace) {
        report_.subjects = shown_subjects(workspace);
        report_.expressions = options.expressions;
        report_.whole_face = options.whole_face;
        report_.zones = reader_.has_truth() ? "truth" : "catalogue";
        report_.alignment = reader_.has_truth() ? "true pose" : "ICP on the stable region";
        report_.truth = reader_.truth_origin();
        for (const auto& method : options.methods) add_row(method.name, method.kind, false);
        if (!with_reference()) return;
        add_row("true field, one source", RowKind::one_source, true);
        add_row("true field, mean", RowKind::mean, true);
    }

    ExperimentReport run() {
        const auto start = std::chrono::steady_clock::now();
        find_usable();
        for (const auto& expression : options_.expressions) score(expression);
        average_over_expressions();
        report_.failures = failures_.sorted();
        report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return std::move(report_);
    }

private:
    [[nodiscard]] bool with_reference() const { return options_.reference && reader_.has_truth(); }
    void add_row(const std::string& name, RowKind kind, bool reference) {
        report_.rows.push_back({name, kind, reference, {}, 0, 0, 0, {}});
    }

    /// A neutral that cannot be used is reported once, not once per expression.
    void find_usable() {
        std::vector<char> usable(report_.subjects.size(), 0);
        base::parallel_for(usable.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) try {
                    reader_.check_neutral(report_.subjects[s]);
                    usable[s] = 1;
                } catch (const std::exception& e) {
                    failures_.add(fmt::format("{}: takes part in no case: {}", report_.subjects[s], e.what()));
                }
        });
        for (std::size_t s = 0; s < usable.size(); ++s)
            if (usable[s]) usable_.push_back(report_.subjects[s]);
    }

    void score(const std::string& expression) {
        const auto cast = gather_cast(reader_, catalogue_, expression, scans_of(workspace_, usable_, expression),
                                      options_.methods, with_reference(), failures_);
        const std::size_t count = cast.participants.size();
        if (count < 3)
            throw InputError(
                fmt::format("expression '{}': {} subjects are left; an experiment needs three or more ({})", expression,
                            count, fmt::join(failures_.sorted(), "; ")));
        const CaseChoice choice{options_.methods, with_reference(), options_.whole_face,
                                static_cast<std::size_t>(options_.max_sources)};
        std::vector<ScoreSum> sums(report_.rows.size());
        const auto add = [](ScoreSum& sum, const std::vector<CaseResult>& cases) {
            for (const auto& result : cases) sum.add(result);
        };
        score_in_order(
            count,
            [&](std::size_t t) {
                auto cases = score_target(reader_, cast, t, choice, failures_);
                if (progress_) progress_(fmt::format("{} {}", expression, cast.participants[t].id.subject));
                return cases;
            },
            [&](const TargetCases& cases) {
                for (std::size_t m = 0; m < cases.methods.size(); ++m) add(sums[m], cases.methods[m]);
                if (!choice.true_fields) return;
                add(sums[cases.methods.size()], cases.true_field);
                add(sums[cases.methods.size() + 1], cases.true_field_mean);
            });
        for (std::size_t r = 0; r < sums.size(); ++r) report_.rows[r].per_expression[expression] = sums[r].score();
    }

    void average_over_expressions() {
        for (auto& row : report_.rows)
            for (const auto& [expression, score] : row.per_expression) {
                const auto count = static_cast<double>(row.per_expression.size());
                row.explained += score.explained / count;
                row.explained_median += score.explained_median / count;
                row.explained_whole += score.explained_whole / count;
            }
        for (auto& row : report_.rows)
            for (const auto& other : report_.rows)
                if (other.reference && other.kind == row.kind && !row.reference && other.explained > 0)
                    row.share = row.explained / other.explained;
    }

    const Workspace& workspace_;
    const facs::FacsCatalogue& catalogue_;
    const ExperimentOptions& options_;
    const std::function<void(const std::string&)>& progress_;
    PerformanceReader reader_;
    FailureList failures_;
    std::vector<std::string> usable_;
    ExperimentReport report_;
};

}  // namespace

ExperimentReport run_experiment(const Workspace& workspace, const facs::FacsCatalogue& catalogue,
                                const ExperimentOptions& options,
                                const std::function<void(const std::string&)>& progress) {
    check_experiment(workspace, catalogue, options);
    return ExperimentRun(workspace, catalogue, options, progress).run();
}

}  // namespace mimik::evaluation
