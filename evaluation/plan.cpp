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
}

std::size_t ExperimentPlan::units() const {
    std::size_t units = 0;
    for (const auto& planned : expressions) units += planned.performances.size();
    return units;
}

std::vector<std::size_t> ExperimentPlan::sources(std::size_t target, std::size_t participants) const {
    std::vector<std::size_t> ring;
    for (std::size_t step = 1; step < participants; ++step) {
        if (max_sources > 0 && ring.size() >= max_sources) break;
        ring.push_back((target + step) % participants);
    }
    return ring;
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

ExperimentPlan plan_experiment(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                               const ExperimentOptions& options, bool truth) {
    options.check();
    ExperimentPlan plan;
    plan.subjects = workspace.shown_subjects();
    plan.whole_face = options.whole_face;
    plan.max_sources = static_cast<std::size_t>(options.max_sources);
    if (options.zones == ZoneSource::truth && !truth)
        throw InputError(fmt::format("zones from the truth need one, and {} has none; give data or catalogue",
                                     workspace.database_root().string()));
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
            add(animation::method_by_name(std::string(bound_of(kind))));
    for (const auto& expression : options.expressions) {
        (void)catalogue.units(expression);
        PlannedExpression planned{expression, {}};
        for (const auto& subject : plan.subjects)
            if (auto id = workspace.scan_of(subject, expression)) planned.performances.push_back(std::move(*id));
        if (planned.performances.size() < fewest_subjects)
            plan.left_out.push_back(fmt::format(
                "expression '{}': left out: {} it; an experiment needs {} or more", expression.code(),
                base::counted(planned.performances.size(), "subject shows", "subjects show"), fewest_subjects));
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
    for (const auto& planned : plan.expressions) {
        const auto participants = planned.performances.size();
        const auto sources = plan.sources(0, participants).size();
        std::size_t per_target = 0;
        for (const auto& method : plan.methods)
            per_target += method->name() == baseline_method           ? 0
                          : method->needs() == SourceKind::one_source ? sources
                                                                      : 1;
        estimate.transfers += participants * per_target;
        estimate.core_seconds += static_cast<double>(participants) * subject_s;
    }
    estimate.core_seconds += static_cast<double>(estimate.transfers) * transfer_s;
    return estimate;
}

}  // namespace mimik::evaluation
