#include "evaluation/target_unit.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "evaluation/estimator.h"
#include "evaluation/score.h"
#include "evaluation/still_skin.h"
#include "evaluation/target_estimators.h"

namespace mimik::evaluation {

using animation::Method;
using animation::PreparedTarget;
using animation::SourceKind;
using geometry::DisplacementField;

namespace {

/// One target while its cases are scored.
class TargetRun {
public:
    TargetRun(const PerformanceReader& reader, const ExperimentPlan& plan, const Cast& cast, std::size_t t,
              FailureList& failures, const CaseVisitor& visit)
        : visit_(visit),
          plan_(plan),
          cast_(cast),
          failures_(failures),
          own_(reader.read(cast.participants[t])),
          prepared_(own_.neutral, own_.true_neutral ? &*own_.true_neutral : nullptr),
          ring_(plan.sources_of(t, cast.participants)),
          aligned_(neutral_from_expressive(plan.alignment, own_)),
          scored_(scored_target(prepared_.surface(), own_.expressive.grid, aligned_,
                                carry_zone(cast.zone, reader.workspace().average(), own_.neutral))),
          still_(DisplacementField::still(prepared_.surface().size())) {
        scored_.whole_face = plan.whole_face;
        if (prepared_.has_truth())
            for (const auto v : scored_.vertices)
                scored_.true_displacement_mm.push_back(
                    prepared_.material_points().at(own_.true_expression->displacement_mm, v));
        scored_.expressive_landmarks = geometry::transformed(own_.expressive.landmarks, aligned_);
        scored_.still = prepared_.has_truth() ? still_by_truth(scored_.true_displacement_mm)
                                              : still_by_scans(prepared_.surface(), scored_);
        if (plan.estimators.empty()) return;
        estimators_.emplace(reader, plan, cast, own_, prepared_.surface(), scored_);
        for (const auto& reason : estimators_->silent()) failures.add(reason);
    }

    std::vector<CaseRow> run() {
        for (std::size_t m = 0; m < plan_.methods.size(); ++m) score_method(m);
        say_if_nothing_moves();
        return std::move(rows_);
    }

private:
    void say_if_nothing_moves() {
        for (const auto& row : rows_)
            if (row.key.method == baseline_method && row.estimator == "surface_distance" && row.region == "zone" &&
                row.value && *row.value <= least_motion_mm)
                failures_.add(fmt::format(
                    "{}: its scan of {} is equal to its neutral scan, so what is explained of it is unknown; scan the "
                    "expression again, or take this one out",
                    row.key.target, row.key.expression));
    }

    void score_method(std::size_t m) {
        const auto& method = *plan_.methods[m];
        if (method.needs() == SourceKind::one_source) {
            auto ascending = ring_;
            std::sort(ascending.begin(), ascending.end());
            for (const auto s : ascending) score_case(m, cast_.participants[s].subject, {s});
        } else {
            score_case(m, method.needs() == SourceKind::none ? "" : "mean",
                       method.needs() == SourceKind::none ? std::vector<std::size_t>() : ring_);
        }
    }

    void score_case(std::size_t m, const std::string& source, const std::vector<std::size_t>& from) {
        const auto& method = *plan_.methods[m];
        CaseKey key{source, own_.neutral.id.subject, cast_.expression.code(), method.name()};
        const auto found = field_of(m, from, key);
        const bool made_by_method = found.field && method.name() != baseline_method && !method.needs_truth();
        for (const double magnitude : plan_.magnitudes_of(method)) {
            key.magnitude = magnitude;
            if (!found.field || magnitude == 1.0) {
                measure(key, {scored_, prepared_.surface(), found.field ? *found.field : still_, made_by_method},
                        found.reason);
                continue;
            }
            auto scaled = *found.field;
            for (auto& way_mm : scaled.mm) way_mm *= magnitude;
            measure(key, {scored_, prepared_.surface(), scaled, made_by_method}, found.reason);
        }
    }

    struct Found {
        std::optional<DisplacementField> field;
        std::string reason;  ///< why there is none
    };

    Found field_of(std::size_t m, const std::vector<std::size_t>& from, const CaseKey& key) {
        if (!cast_.lessons.can_learn(m)) return {std::nullopt, "no model of any source"};  // reported when it was tried
        try {
            std::vector<animation::LessonPointer> lessons;
            for (const auto s : from)
                if (auto lesson = cast_.lessons.lesson(m, s)) lessons.push_back(std::move(lesson));
            if (!from.empty() && lessons.empty())
                return {std::nullopt, "no model of its sources"};  // reported when they were studied
            return {animation::field_on(*cast_.lessons.learner(m).learn(lessons), prepared_), ""};
        } catch (const std::exception& e) {
            failures_.add(
                fmt::format("{}: {} -> {} by {}: {}", key.expression, key.source, key.target, key.method, e.what()));
            return {std::nullopt, e.what()};
        }
    }

    void measure(const CaseKey& key, const JudgedFace& judged, const std::string& no_answer) {
        if (visit_ && no_answer.empty()) visit_(key, judged);
        const auto reason = no_answer.empty() ? std::string() : "scored as doing nothing: " + no_answer;
        for (const auto& estimator : known_estimators())
            for (const auto& found : estimator->measure(judged))
                rows_.push_back({key, estimator->name(), found.region, found.metric, found.value, found.unit, reason});
        if (!estimators_) return;
        for (const auto& [estimator, found] : estimators_->measure(judged))
            rows_.push_back({key, estimator, found.region, found.metric, found.value, found.unit, reason});
    }

    const CaseVisitor& visit_;
    const ExperimentPlan& plan_;
    const Cast& cast_;
    FailureList& failures_;
    modeling::Performance own_;
    PreparedTarget prepared_;
    std::vector<std::size_t> ring_;  // the sources, as means take them
    geometry::Transform aligned_;    // neutral from expressive, by the plan's alignment
    ScoredTarget scored_;
    std::optional<TargetEstimators> estimators_;  // those that the plan asks for
    DisplacementField still_;
    std::vector<CaseRow> rows_;
};

}  // namespace

std::vector<CaseRow> score_target(const PerformanceReader& reader, const ExperimentPlan& plan, const Cast& cast,
                                  std::size_t t, FailureList& failures, const CaseVisitor& visit) {
    try {
        return TargetRun(reader, plan, cast, t, failures, visit).run();
    } catch (const std::exception& e) {
        failures.add(fmt::format("{}: no case with target {}: {}", cast.expression.code(), cast.participants[t].subject,
                                 e.what()));
        return {};
    }
}

void in_order(std::size_t count, const std::function<std::vector<CaseRow>(std::size_t)>& work,
              const std::function<void(std::size_t, const std::vector<CaseRow>&)>& take) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::map<std::size_t, std::vector<CaseRow>> waiting;
    std::size_t taken = 0;
    std::map<std::size_t, std::exception_ptr> faults;  // by unit
    base::parallel_for_each(count, [&](std::size_t) {
        // Whichever piece the scheduler begins, it does the first unit that nobody has begun.
        const std::size_t t = next.fetch_add(1);
        {
            const std::scoped_lock lock(mutex);
            if (!faults.empty() && faults.begin()->first < t) return;
        }
        std::vector<CaseRow> rows;
        std::exception_ptr fault;
        try {
            rows = work(t);
        } catch (...) {
            fault = std::current_exception();
        }
        const std::scoped_lock lock(mutex);
        if (fault)
            faults.emplace(t, fault);
        else
            waiting.emplace(t, std::move(rows));
        for (auto first = waiting.begin(); first != waiting.end() && first->first == taken;
             first = waiting.erase(first), ++taken)
            try {
                if (faults.empty() || first->first < faults.begin()->first) take(first->first, first->second);
            } catch (...) {
                faults.emplace(first->first, std::current_exception());
            }
    });
    if (!faults.empty()) std::rethrow_exception(faults.begin()->second);
}

}  // namespace mimik::evaluation
