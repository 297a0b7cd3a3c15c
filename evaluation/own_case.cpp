#include "evaluation/own_case.h"

#include <algorithm>
#include <exception>

#include <fmt/format.h>

#include "base/errors.h"
#include "evaluation/cast.h"
#include "evaluation/scored_target.h"

namespace mimik::evaluation {

using database::ScanId;
using facs::FacsCatalogue;
using geometry::Point;

namespace {

/// A face for which a method has no answer is as bad as twice doing nothing: a search must not run there.
constexpr double no_answer_share = 2.0;

}  // namespace

OwnCase::OwnCase(const PerformanceReader& reader, const ScanId& scan, const ActiveZone& zone,
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

OwnCase::Errors OwnCase::errors(const FacsCatalogue& catalogue, const animation::ModelMethod& method,
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

std::unique_ptr<const OwnCase> ready_case(const PlannedCase& planned, const animation::ModelMethod& method,
                                          std::size_t most_vertices, FailureList& failures) {
    try {
        return std::make_unique<const OwnCase>(*planned.reader, planned.scan, *planned.zone, method, most_vertices);
    } catch (const std::exception& e) {
        failures.add(fmt::format("{}: takes no part: {}", planned.scan.name(), e.what()));
        return nullptr;
    }
}

FacsCatalogue unit_alone(const FacsCatalogue& catalogue, const facs::ActionUnit& unit) {
    return {catalogue.sampling(), {unit}, {}, catalogue.name()};
}

void require_points_on_source(const animation::ModelMethod& method) {
    if (method.model_options().place_on_average ||
        method.model_options().correspondence != modeling::Correspondence::sparse)
        throw InputError(
            fmt::format("method '{}' does not place its points on the source; take 'thesis'", method.name()));
}

}  // namespace mimik::evaluation
