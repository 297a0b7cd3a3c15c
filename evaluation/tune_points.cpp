#include "evaluation/tune_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "animation/animate.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "evaluation/active_zone.h"
#include "evaluation/cast.h"
#include "evaluation/estimator.h"
#include "evaluation/scored_target.h"
#include "facs/reference_face.h"
#include "geometry/face_axes.h"

namespace mimik::evaluation {

using database::ScanId;
using facs::CataloguePoint;
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

/// A face for which a method has no answer is as bad as twice doing nothing: a search must not run there.
constexpr double no_answer_share = 2.0;

/// One scan of an expression, made ready to be put on its own neutral face again and again.
class OwnCase {
public:
    OwnCase(const PerformanceReader& reader, const ScanId& scan, const ActiveZone& zone,
            const animation::ModelMethod& method, std::size_t most_vertices)
        : expression_(zone.expression), average_(reader.workspace().average()) {
        const auto own = reader.read(scan);
        target_.emplace(own.neutral);
        source_ = std::make_unique<modeling::NormalisedSource>(own.neutral, own.expressive, method.model_options());
        auto scored = scored_target(target_->surface(), own.expressive.grid, own.neutral_from_expressive,
                                    carry_zone(zone, average_, own.neutral));
        expressive_ = std::move(scored.expressive);
        for (std::size_t k = 0; k < scored.vertices.size(); ++k) {
            if (!scored.in_zone[k]) continue;
            zone_.push_back(scored.vertices[k]);
            zone_nothing_mm_.push_back(scored.nothing_mm[k]);
        }
        if (zone_.empty())
            throw NumericalError(
                "no vertex of the active zone sees the real expressive scan: it does not lie on the "
                "neutral face there");
        const std::size_t stride = (zone_.size() + most_vertices - 1) / most_vertices;
        for (std::size_t k = 0; k < zone_.size(); k += stride) {
            sample_.push_back(zone_[k]);
            sample_nothing_mm_.push_back(zone_nothing_mm_[k]);
        }
    }

    struct Errors {
        double own_mm = 0, nothing_mm = 0;
    };
    /// With the points of a catalogue. @param whole_zone  else the vertices that the search looks at
    [[nodiscard]] Errors errors(const FacsCatalogue& catalogue, const animation::ModelMethod& method,
                                bool whole_zone) const {
        const auto& vertices = whole_zone ? zone_ : sample_;
        const auto& nothing_mm = whole_zone ? zone_nothing_mm_ : sample_nothing_mm_;
        Errors errors;
        for (const double mm : nothing_mm) errors.nothing_mm += mm / static_cast<double>(nothing_mm.size());
        try {
            const modeling::ExpressionGauge gauge(catalogue, expression_, average_, method.model_options());
            const auto model = gauge.measure(*source_);
            const auto way_mm = animation::displacements_at(*target_, model, method.animation_options(), vertices);
            std::vector<Point> moved;
            for (std::size_t k = 0; k < vertices.size(); ++k)
                moved.emplace_back(target_->surface().vertices_mm[vertices[k]] + way_mm[k]);
            for (const auto& hit : expressive_->closest(moved))
                errors.own_mm += hit.distance_mm / static_cast<double>(vertices.size());
        } catch (const InputError&) {
            errors.own_mm = no_answer_share * errors.nothing_mm;
        } catch (const NumericalError&) {
            errors.own_mm = no_answer_share * errors.nothing_mm;
        }
        return errors;
    }
    [[nodiscard]] const facs::Expression& expression() const { return expression_; }

private:
    facs::Expression expression_;
    const preprocessing::AverageFace& average_;
    std::optional<animation::PreparedTarget> target_;
    std::unique_ptr<modeling::NormalisedSource> source_;
    std::optional<geometry::SurfaceIndex> expressive_;
    std::vector<std::uint32_t> zone_, sample_;
    std::vector<double> zone_nothing_mm_, sample_nothing_mm_;
};

/// Where a case comes from, before it is read.
struct PlannedCase {
    const PerformanceReader* reader = nullptr;
    ScanId scan;
    std::shared_ptr<const ActiveZone> zone;
};

/// The scans of one expression by subjects of a workspace, with the zone that all its subjects show.
std::vector<PlannedCase> planned_cases(const TuneGroup& group, const FacsCatalogue& catalogue,
                                       const facs::Expression& expression, FailureList& failures) {
    const auto& workspace = group.reader->workspace();
    std::vector<ScanId> shown;
    for (const auto& subject : workspace.shown_subjects())
        if (auto id = workspace.scan_of(subject, expression)) shown.push_back(std::move(*id));
    std::vector<PlannedCase> planned;
    if (shown.empty()) return planned;
    const animation::LearningTask task{expression, workspace.average(), catalogue, workspace.registrations()};
    const auto cast = gather_cast(*group.reader, task, shown, {}, failures);
    const auto zone = std::make_shared<const ActiveZone>(cast.zone);
    for (const auto& id : cast.participants)
        if (std::find(group.subjects.begin(), group.subjects.end(), id.subject) != group.subjects.end())
            planned.push_back({group.reader, id, zone});
    return planned;
}

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

/// The catalogue with this unit alone: what a search copies for every step.
FacsCatalogue unit_alone(const FacsCatalogue& catalogue, const facs::ActionUnit& unit) {
    return {catalogue.sampling(), {unit}, {}, catalogue.name()};
}

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
        try {
            return std::make_unique<const OwnCase>(*planned.reader, planned.scan, *planned.zone, method_,
                                                   static_cast<std::size_t>(options_.most_vertices));
        } catch (const std::exception& e) {
            failures_.add(fmt::format("{}: takes no part in tuning: {}", planned.scan.name(), e.what()));
            return nullptr;
        }
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
    if (method.model_options().place_on_average ||
        method.model_options().correspondence != modeling::Correspondence::sparse)
        throw InputError(
            fmt::format("method '{}' does not place its points on the source; tune 'thesis'", method.name()));
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
