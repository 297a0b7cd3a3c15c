#include "evaluation/plan.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"
#include "evaluation/score.h"
#include "evaluation/scored_region.h"

namespace mimik::evaluation {

using animation::SourceKind;

std::string_view bound_of(SourceKind kind) {
    return kind == SourceKind::one_source ? "true-field" : kind == SourceKind::all_but_target ? "true-field-mean" : "";
}

std::vector<facs::Expression> ExperimentOptions::thesis_expressions() {
    std::vector<facs::Expression> expressions;
    for (const int unit : {1, 2, 4, 12, 14, 15, 17, 20})
        expressions.push_back(facs::Expression::of_units({{unit, facs::Side::both, false}}));
    expressions.push_back(facs::Expression::of_units({{12, facs::Side::left, false}}));
    return expressions;
}

void ExperimentOptions::check() const {
    if (methods.empty()) throw InputError("an experiment without a method; give one or more of thesis, default, mean");
    if (expressions.empty())
        throw InputError("an experiment without an expression; give one or more, such as 12 or HAPPY");
    for (std::size_t k = 0; k < expressions.size(); ++k)
        if (std::count(expressions.begin(), expressions.begin() + static_cast<std::ptrdiff_t>(k), expressions[k]) > 0)
            throw InputError(
                fmt::format("expression '{}' is asked for twice; its cases would count twice", expressions[k].code()));
    for (std::size_t k = 0; k < methods.size(); ++k)
        for (std::size_t other = 0; other < k; ++other)
            if (methods[k]->name() == methods[other]->name())
                throw InputError(fmt::format("method '{}' is asked for twice; give it once", methods[k]->name()));
    for (std::size_t k = 0; k < estimators.size(); ++k)
        if (std::count(estimators.begin(), estimators.begin() + static_cast<std::ptrdiff_t>(k), estimators[k]) > 0)
            throw InputError(fmt::format("estimator '{}' is asked for twice; give it once", to_string(estimators[k])));
    if (regions.empty()) throw InputError("an experiment without a region; give one or more, such as zone or face");
    for (std::size_t k = 0; k < regions.size(); ++k) {
        check_region(regions[k]);
        if (std::count(regions.begin(), regions.begin() + static_cast<std::ptrdiff_t>(k), regions[k]) > 0)
            throw InputError(fmt::format("region '{}' is asked for twice; give it once", regions[k]));
    }
    metrics.check();
    if (max_sources < 0) throw InputError(fmt::format("max_sources is {}; give 0 (all) or more", max_sources));
    if (magnitudes.empty()) throw InputError("magnitudes is empty; give one or more, such as 1");
    for (std::size_t k = 0; k < magnitudes.size(); ++k) {
        if (!(magnitudes[k] > 0) || magnitudes[k] > largest_magnitude)
            throw InputError(
                fmt::format("magnitudes has {}; give numbers above 0, up to {}", magnitudes[k], largest_magnitude));
        if (std::count(magnitudes.begin(), magnitudes.begin() + static_cast<std::ptrdiff_t>(k), magnitudes[k]) > 0)
            throw InputError(fmt::format("magnitudes has {} twice; its cases would count twice", magnitudes[k]));
    }
    if (on_itself && (!sources.empty() || max_sources > 0))
        throw InputError("on_itself puts each source on its own face; name targets, and leave the sources out");
    if (on_itself)
        for (const auto& method : methods)
            if (method->needs() != SourceKind::one_source)
                throw InputError(
                    fmt::format("on_itself puts each source on its own face, and method '{}' has no one "
                                "source; leave it out, or score it on others",
                                method->name()));
}

std::size_t ExperimentPlan::units() const {
    std::size_t units = 0;
    for (const auto& planned : expressions)
        for (const auto& id : planned.performances) units += is_target(id.subject) ? 1 : 0;
    return units;
}

bool ExperimentPlan::is_target(const std::string& subject) const {
    return targets.empty() || targets.contains(subject);
}

std::vector<std::size_t> ExperimentPlan::sources_of(std::size_t target,
                                                    std::span<const database::ScanId> participants) const {
    if (on_itself) return {target};
    std::vector<std::size_t> ring;
    for (std::size_t step = 1; step < participants.size(); ++step) {
        if (max_sources > 0 && ring.size() >= max_sources) break;
        const auto next = (target + step) % participants.size();
        if (sources.empty() || sources.contains(participants[next].subject)) ring.push_back(next);
    }
    return ring;
}

std::vector<double> ExperimentPlan::magnitudes_of(const animation::Method& method) const {
    return method.needs_truth() || method.name() == baseline_method ? std::vector{1.0} : magnitudes;
}

namespace {

/// @throws InputError where one needs a truth that is not there.
void add_estimators(ExperimentPlan& plan, const ExperimentOptions& options, bool truth) {
    plan.estimators = options.estimators;
    plan.regions = options.regions;
    plan.metrics = options.metrics;
    plan.alignment = options.alignment;
    bool curvature = false;
    for (const auto& choice : options.estimators) {
        if (choice.correspondence == Correspondence::truth && !truth)
            throw InputError(fmt::format(
                "estimator '{}' looks at the truth of a synthetic database, and there is none; leave it out",
                to_string(choice)));
        curvature = curvature || choice.distance == Distance::curvature;
    }
    if (curvature && std::find(plan.regions.begin(), plan.regions.end(), "wrinkles") == plan.regions.end())
        plan.regions.emplace_back("wrinkles");
}

}  // namespace

std::set<std::string> known_subjects(const preprocessing::Workspace& workspace, const std::vector<std::string>& asked) {
    const auto shown = workspace.shown_subjects();
    for (const auto& subject : asked) {
        if (std::find(shown.begin(), shown.end(), subject) != shown.end()) continue;
        workspace.refuse_hidden(subject);
        throw InputError(fmt::format("no subject {} in {}; there are {}", base::in_quotes(subject),
                                     workspace.root().string(), fmt::join(shown, ", ")));
    }
    return {asked.begin(), asked.end()};
}

ExperimentPlan plan_experiment(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                               const ExperimentOptions& options, bool truth) {
    options.check();
    ExperimentPlan plan;
    plan.subjects = workspace.shown_subjects();
    plan.whole_face = options.whole_face;
    plan.max_sources = static_cast<std::size_t>(options.max_sources);
    plan.on_itself = options.on_itself;
    if (options.zones == ZoneSource::truth && !truth)
        throw InputError(fmt::format("zones from the truth need one, and {} has none; give data or catalogue",
                                     workspace.database_root().string()));
    plan.magnitudes = options.magnitudes;
    plan.targets = known_subjects(workspace, options.targets);
    plan.sources = known_subjects(workspace, options.sources);
    plan.zones = options.zones != ZoneSource::automatic ? options.zones : truth ? ZoneSource::truth : ZoneSource::data;
    add_estimators(plan, options, truth);
    const auto has = [&](const std::string& name) {
        return std::any_of(plan.methods.begin(), plan.methods.end(), [&](const auto& m) { return m->name() == name; });
    };
    const auto add = [&](const animation::MethodPointer& method) {
        if (!has(method->name())) plan.methods.push_back(method);
    };
    add(animation::method_by_name(baseline_method));
    for (const auto& method : options.methods) {
        if (method->needs_truth() && !truth)
            throw InputError(fmt::format("method '{}' looks at the truth of a synthetic database, and {} has none",
                                         method->name(), workspace.database_root().string()));
        add(method);
    }
    if (options.reference && truth)
        for (const auto kind : {SourceKind::one_source, SourceKind::all_but_target})
            if (kind == SourceKind::one_source || !options.on_itself)
                add(animation::method_by_name(std::string(bound_of(kind))));
    for (const auto& expression : options.expressions) {
        (void)catalogue.units(expression);
        PlannedExpression planned{expression, {}};
        for (const auto& subject : plan.subjects)
            if (auto id = workspace.scan_of(subject, expression)) planned.performances.push_back(std::move(*id));
        if (planned.performances.size() < plan.fewest())
            plan.left_out.push_back(fmt::format(
                "expression '{}': left out: {} it; an experiment needs {} or more", expression.code(),
                base::counted(planned.performances.size(), "subject shows", "subjects show"), plan.fewest()));
        else
            plan.expressions.push_back(std::move(planned));
    }
    if (plan.expressions.empty())
        throw InputError(fmt::format("{}: {}", workspace.root().string(), fmt::join(plan.left_out, "; ")));
    return plan;
}

ExperimentEstimate estimate(const ExperimentPlan& plan) {
    // Processor time on an AMD EPYC at 2.6 GHz: 14 subjects of ICT-FaceKit, 150 x 150 vertices, AU 1, 12 and 17.
    constexpr double subject_s = 0.06;    // read three times, measured, made ready as a target
    constexpr double transfer_s = 0.009;  // 7 ms by the default, 11 by thesis, 9 of a true field, whole face included
    ExperimentEstimate estimate;
    for (const auto& planned : plan.expressions)
        for (std::size_t t = 0; t < planned.performances.size(); ++t) {
            estimate.core_seconds += subject_s / 2;  // as a source
            if (!plan.is_target(planned.performances[t].subject)) continue;
            estimate.core_seconds += subject_s / 2;
            const auto sources = plan.sources_of(t, planned.performances).size();
            for (const auto& method : plan.methods) {
                if (method->name() == baseline_method) continue;
                estimate.transfers +=
                    (method->needs() == SourceKind::one_source ? sources : 1) * plan.magnitudes_of(*method).size();
            }
        }
    estimate.core_seconds += static_cast<double>(estimate.transfers) * transfer_s;
    return estimate;
}

}  // namespace mimik::evaluation
