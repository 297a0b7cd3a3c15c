#include "evaluation/tune_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "evaluation/own_case.h"
#include "facs/reference_face.h"
#include "geometry/face_axes.h"

namespace mimik::evaluation {

using facs::ControlKind;
using facs::FacsCatalogue;
using geometry::Point;

void TuneOptions::check() const {
    if (!(std::isfinite(most_mm) && most_mm > 0))
        throw InputError(fmt::format("most_mm is {}; give more than 0, such as 8", most_mm));
    if (most_vertices < 1) throw InputError(fmt::format("most_vertices is {}; give 1 or more", most_vertices));
    search.check();
}

namespace {

/// "12", and where they are wanted "12L" and "12R".
std::vector<facs::Expression> expressions_of(const facs::ActionUnit& unit, const TuneOptions& options) {
    std::vector<facs::Expression> expressions = {facs::Expression::of_units({{unit.number, facs::Side::both, false}})};
    if (options.one_sided && !unit.central)
        for (const auto side : {facs::Side::left, facs::Side::right})
            expressions.push_back(facs::Expression::of_units({{unit.number, side, false}}));
    return expressions;
}

std::vector<PlannedCase> all_planned(std::span<const TuneGroup> groups, const FacsCatalogue& catalogue,
                                     const facs::ActionUnit& unit, const TuneOptions& options, FailureList& failures) {
    std::vector<PlannedCase> planned;
    for (const auto& expression : expressions_of(unit, options))
        for (const auto& group : groups) {
            auto more = planned_cases(group, catalogue, expression, failures);
            std::move(more.begin(), more.end(), std::back_inserter(planned));
        }
    return planned;
}

/// Variables are millimetres on the reference face: [lateral, up] of a point, of one on the midline [up].
class PointMoves {
public:
    PointMoves(const facs::ActionUnit& unit, const TuneOptions& options)
        : unit_(unit), most_mm_(options.most_mm), mm_(geometry::outer_eye_distance_mm(facs::reference_landmarks())) {
        for (std::size_t k = 0; k < unit.points.size(); ++k) {
            if (unit.points[k].kind == ControlKind::carried && !options.carried) continue;
            const bool midline = facs::on_midline(unit.points[k].placement);
            moves_.push_back({k, midline, variables_});
            variables_ += midline ? 1 : 2;
        }
    }

    [[nodiscard]] std::size_t variables() const { return variables_; }

    void clip(std::span<double> at) const {
        for (const auto& move : moves_) {
            double& last = at[move.first + (move.midline ? 0 : 1)];
            if (move.midline) {
                last = std::clamp(last, -most_mm_, most_mm_);
                continue;
            }
            const double length = std::hypot(at[move.first], last);
            if (length <= most_mm_) continue;
            at[move.first] *= most_mm_ / length;
            last *= most_mm_ / length;
        }
    }

    [[nodiscard]] std::vector<MovedPoint> points(std::span<const double> at) const {
        std::vector<MovedPoint> points;
        for (const auto& move : moves_) {
            const auto& point = unit_.points[move.point];
            const double lateral_mm = move.midline ? 0 : at[move.first];
            const double up_mm = at[move.first + (move.midline ? 0 : 1)];
            points.push_back({point.name, written(point.placement.lateral + lateral_mm / mm_),
                              written(point.placement.up + up_mm / mm_), point.placement.lateral, point.placement.up,
                              std::hypot(lateral_mm, up_mm)});
        }
        return points;
    }

    /// Whether no point left its half of the reference face, or that face, that was there before.
    [[nodiscard]] bool allowed(std::span<const MovedPoint> points) const {
        constexpr double least_lateral_mm = 1.5;  // the linter refuses 1 mm: a point on its own mirror image
        for (std::size_t k = 0; k < points.size(); ++k) {
            auto placement = unit_.points[moves_[k].point].placement;
            const Point before = facs::place(placement, facs::reference_landmarks(), facs::Side::left);
            placement.lateral = points[k].lateral;
            placement.up = points[k].up;
            const Point after = facs::place(placement, facs::reference_landmarks(), facs::Side::left);
            if (!moves_[k].midline && after.x() < least_lateral_mm) return false;
            if (facs::on_reference_face(before) && !facs::on_reference_face(after)) return false;
        }
        return true;
    }

private:
    struct Move {
        std::size_t point = 0;  // of the unit
        bool midline = false;
        std::size_t first = 0;  // variable
    };
    /// As a catalogue has it, to a tenth of a millimetre: what is scored is what is written.
    static double written(double offset) { return std::round(offset * 1000.0) / 1000.0; }

    const facs::ActionUnit& unit_;
    double most_mm_, mm_;
    std::vector<Move> moves_;
    std::size_t variables_ = 0;
};

void move_points(facs::ActionUnit& unit, std::span<const MovedPoint> points) {
    for (const auto& moved : points)
        for (auto& point : unit.points)
            if (point.name == moved.name) {
                point.placement.lateral = moved.lateral;
                point.placement.up = moved.up;
            }
}

/// One unit while it is tuned.
class UnitRun {
public:
    UnitRun(const facs::ActionUnit& unit, const FacsCatalogue& catalogue, const animation::ModelMethod& method,
            const TuneOptions& options, FailureList& failures)
        : unit_(unit), catalogue_(catalogue), method_(method), options_(options), failures_(failures) {}

    TunedUnit run(std::span<const TuneGroup> training, std::span<const TuneGroup> unseen,
                  const std::function<void(int, double)>& done) {
        const auto planned = all_planned(training, catalogue_, unit_, options_, failures_);
        cases_.resize(planned.size());
        base::parallel_for_each(planned.size(), [&](std::size_t k) { cases_[k] = ready(planned[k]); });
        if (std::none_of(cases_.begin(), cases_.end(), [](const auto& own) { return own != nullptr; }))
            throw InputError(
                fmt::format("AU{}: no training subject shows it, so there is nothing to tune by", unit_.number));
        const PointMoves moves(unit_, options_);
        if (moves.variables() == 0)
            throw InputError(
                fmt::format("AU{}: none of its points may move; let carried points move, too", unit_.number));
        const auto found = geometry::pattern_search(
            std::vector<double>(moves.variables(), 0.0),
            [&](std::span<const double> at) {
                const auto points = moves.points(at);
                return moves.allowed(points) ? share_of_nothing(points) : std::numeric_limits<double>::infinity();
            },
            [&](std::span<double> at) { moves.clip(at); }, options_.search, done);

        TunedUnit tuned;
        tuned.unit = unit_.number;
        tuned.points = moves.points(found.best);
        tuned.evaluations = found.evaluations;
        tuned.converged = found.converged;
        const auto before = unit_alone(catalogue_, unit_), after = moved(tuned.points);
        tuned.training = scores(planned, before, after, true);
        tuned.unseen = scores(all_planned(unseen, catalogue_, unit_, options_, failures_), before, after, false);
        return tuned;
    }

private:
    [[nodiscard]] std::unique_ptr<const OwnCase> ready(const PlannedCase& planned) const {
        return ready_case(planned, method_, static_cast<std::size_t>(options_.most_vertices), failures_);
    }

    [[nodiscard]] FacsCatalogue moved(std::span<const MovedPoint> points) const {
        auto unit = unit_;
        move_points(unit, points);
        return unit_alone(catalogue_, unit);
    }

    /// What the search lowers.
    [[nodiscard]] double share_of_nothing(std::span<const MovedPoint> points) const {
        const auto catalogue = moved(points);
        std::vector<OwnCase::Errors> errors(cases_.size());
        base::parallel_for_each(cases_.size(), [&](std::size_t k) {
            if (cases_[k]) errors[k] = cases_[k]->errors(catalogue, method_, false);
        });
        double own_mm = 0, nothing_mm = 0;
        for (const auto& error : errors) {
            own_mm += error.own_mm;
            nothing_mm += error.nothing_mm;
        }
        return nothing_mm > 0 ? own_mm / nothing_mm : 0;
    }

    /// Over the whole zones. @param kept  whether the cases are in memory; else each is read and dropped
    [[nodiscard]] std::vector<OwnScore> scores(std::span<const PlannedCase> planned, const FacsCatalogue& before,
                                               const FacsCatalogue& after, bool kept) const {
        struct Found {
            bool any = false;
            OwnCase::Errors before, after;
        };
        std::vector<Found> found(planned.size());
        base::parallel_for_each(planned.size(), [&](std::size_t k) {
            const auto read = kept ? nullptr : ready(planned[k]);
            const auto* own = kept ? cases_[k].get() : read.get();
            if (own) found[k] = {true, own->errors(before, method_, true), own->errors(after, method_, true)};
        });
        std::vector<OwnScore> scores;
        for (std::size_t k = 0; k < planned.size(); ++k) {
            if (!found[k].any) continue;
            if (scores.empty() || scores.back().expression != planned[k].zone->expression)
                scores.push_back({planned[k].zone->expression});
            auto& score = scores.back();
            ++score.cases;
            score.before_mm += found[k].before.own_mm;
            score.after_mm += found[k].after.own_mm;
            score.nothing_mm += found[k].before.nothing_mm;
        }
        for (auto& score : scores)
            for (double* mm : {&score.before_mm, &score.after_mm, &score.nothing_mm})
                *mm /= static_cast<double>(score.cases);
        return scores;
    }

    const facs::ActionUnit& unit_;
    const FacsCatalogue& catalogue_;
    const animation::ModelMethod& method_;
    const TuneOptions& options_;
    FailureList& failures_;
    std::vector<std::unique_ptr<const OwnCase>> cases_;
};

}  // namespace

TunedUnit tune_points(std::span<const TuneGroup> training, std::span<const TuneGroup> unseen,
                      const FacsCatalogue& catalogue, int unit, const animation::ModelMethod& method,
                      const TuneOptions& options, FailureList& failures, const std::function<void(int, double)>& done) {
    options.check();
    require_points_on_source(method);
    const auto* known = catalogue.find(unit);
    if (!known) throw InputError(fmt::format("AU{} is not in the {}; nothing to tune", unit, catalogue.name()));
    return UnitRun(*known, catalogue, method, options, failures).run(training, unseen, done);
}

FacsCatalogue with_moved_points(const FacsCatalogue& catalogue, const TunedUnit& tuned) {
    auto units = catalogue.action_units();
    for (auto& unit : units)
        if (unit.number == tuned.unit) move_points(unit, tuned.points);
    return {catalogue.sampling(), std::move(units), catalogue.all_emotions(), catalogue.name()};
}

}  // namespace mimik::evaluation
