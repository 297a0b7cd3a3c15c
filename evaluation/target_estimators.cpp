#include "evaluation/target_estimators.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/errors.h"
#include "evaluation/registered_places.h"
#include "evaluation/scored_region.h"
#include "preprocessing/normalisation.h"

namespace mimik::evaluation {

using geometry::Transform;

Transform neutral_from_expressive(Alignment alignment, const modeling::Performance& own) {
    switch (alignment) {
        case Alignment::none:
            return Transform::Identity();
        case Alignment::landmarks:
            return preprocessing::rigid_by_landmarks(own.expressive.landmarks, own.neutral.landmarks);
        case Alignment::stable_region:
            return own.expressive.neutral_from_scan;
        case Alignment::given:
            break;
    }
    return own.neutral_from_expressive;
}

struct TargetEstimators::View {
    std::optional<ScoredTarget> own;  ///< where the alignment is another than the plan's
    std::optional<EstimatedTarget> target;
};

TargetEstimators::TargetEstimators(const PerformanceReader& reader, const ExperimentPlan& plan, const Cast& cast,
                                   const modeling::Performance& own, const geometry::FaceSurface& neutral,
                                   const ScoredTarget& scored)
    : reader_(reader), plan_(plan), cast_(cast), own_(own), neutral_(neutral), scored_(scored) {
    for (const auto& choice : plan.estimators) (void)view(choice.alignment);
}

TargetEstimators::~TargetEstimators() = default;

TargetEstimators::View& TargetEstimators::view(Alignment alignment) {
    if (alignment == Alignment::given) alignment = plan_.alignment;
    auto& kept = views_[alignment];
    if (kept) return *kept;
    kept = std::make_unique<View>();
    const auto& average = reader_.workspace().average();
    const auto zone = carry_zone(cast_.zone, average, own_.neutral);
    const Transform aligned = neutral_from_expressive(alignment, own_);
    if (alignment != plan_.alignment) kept->own = scored_target(neutral_, own_.expressive.grid, aligned, zone);
    kept->target.emplace(kept->own ? *kept->own : scored_, neutral_,
                         regions_on(own_.neutral, average, cast_.catalogue, cast_.expression, zone, plan_.regions));
    add_places(*kept, aligned);
    return *kept;
}

void TargetEstimators::add_places(View& view, const Transform& aligned) {
    const auto wants = [&](Correspondence correspondence) {
        return std::any_of(plan_.estimators.begin(), plan_.estimators.end(),
                           [&](const auto& choice) { return choice.correspondence == correspondence; });
    };
    auto& target = *view.target;
    if (wants(Correspondence::registered) && !target.vertices().empty()) try {
            target.registered_places = registered_places(*reader_.workspace().registrations(), own_.neutral,
                                                         own_.expressive, aligned, target.vertices());
        } catch (const std::exception& e) {
            silent_.push_back(fmt::format("{}: no registered place: {}", own_.expressive.id.name(), e.what()));
        }
    if (!wants(Correspondence::truth) || !own_.true_expression) return;
    // The truth is known on the scan, and goes where the alignment takes the scan.
    const Transform aligned_from_true = aligned * own_.neutral_from_expressive.inverse();
    std::map<std::uint32_t, std::size_t> place;
    for (std::size_t k = 0; k < scored_.vertices.size(); ++k) place[scored_.vertices[k]] = k;
    SkinPlaces places;
    for (const auto v : target.vertices()) {
        const auto known = place.find(v);
        places.known.push_back(known != place.end() ? 1 : 0);
        places.place_mm.emplace_back(
            known == place.end() ? neutral_.vertices_mm[v]
                                 : aligned_from_true * geometry::Point(neutral_.vertices_mm[v] +
                                                                       scored_.true_displacement_mm[known->second]));
    }
    target.true_places = std::move(places);
}

std::vector<TargetEstimators::Estimate> TargetEstimators::measure(const JudgedFace& face) {
    std::map<const View*, CaseEstimates> cases;
    std::vector<Estimate> estimates;
    for (const auto& choice : plan_.estimators) {
        auto& seen = view(choice.alignment);
        if (seen.target->vertices().empty()) continue;
        auto& one = cases.try_emplace(&seen, *seen.target, face).first->second;
        for (auto& measure : one.measure(choice, plan_.metrics))
            estimates.push_back({to_string(choice), std::move(measure)});
    }
    return estimates;
}

}  // namespace mimik::evaluation
