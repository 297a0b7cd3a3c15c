#pragma once

#include <optional>
#include <vector>

#include "evaluation/error_metrics.h"
#include "evaluation/estimated_target.h"
#include "evaluation/estimator.h"
#include "evaluation/estimator_choice.h"

namespace mimik::evaluation {

/// One synthetic face before the estimators. What several of them need is made once. References are kept; one thread at
/// a time.
class CaseEstimates {
public:
    /// @param face  of the target that `target` looks at
    CaseEstimates(EstimatedTarget& target, const JudgedFace& face);

    /// The figures of one estimator in every region of the target; none where it needs a truth or a registration that
    /// is not there. The alignment of `choice` is that of `target`, and not looked at.
    [[nodiscard]] std::vector<Measure> measure(const EstimatorChoice& choice, const MetricOptions& options = {});

    /// The error of every vertex of EstimatedTarget::vertices(); empty: the vertex does not count.
    [[nodiscard]] std::vector<std::optional<double>> errors(Correspondence correspondence, Distance distance);
    /// The distance of every place of EstimatedTarget::reverse() to the synthetic face.
    [[nodiscard]] const std::vector<double>& reverse_errors_mm();

private:
    struct Partner {
        geometry::Point place_mm = geometry::Point::Zero();
        geometry::SurfacePoint on_real;  ///< the place itself, or the real surface's point nearest to it
    };
    [[nodiscard]] const std::vector<std::optional<Partner>>& partners(Correspondence correspondence);
    [[nodiscard]] std::vector<std::optional<Partner>> closest_partners() const;
    [[nodiscard]] std::vector<std::optional<Partner>> partners_along_normals();
    [[nodiscard]] std::vector<std::optional<Partner>> partners_at(const std::optional<SkinPlaces>& places) const;
    [[nodiscard]] const std::vector<geometry::Vector>& normals();
    [[nodiscard]] std::optional<double> curvature_per_m(std::size_t k);
    [[nodiscard]] std::vector<RegionErrors> by_region(const std::vector<std::optional<double>>& errors,
                                                      bool by_area) const;
    [[nodiscard]] std::vector<RegionErrors> reverse_by_region(bool by_area);
    [[nodiscard]] std::vector<Measure> hausdorff(const MetricOptions& options);

    EstimatedTarget& target_;
    const JudgedFace& face_;
    std::vector<geometry::Point> moved_mm_;  ///< every vertex of the neutral face, moved
    std::vector<geometry::Point> asked_mm_;  ///< parallel to EstimatedTarget::vertices()
    std::array<std::optional<std::vector<std::optional<Partner>>>, 4> partners_;
    std::optional<std::vector<geometry::Vector>> normals_;  ///< of the moved face, per vertex
    std::vector<geometry::Point> present_mm_;               ///< of the moved face, for curvatures
    std::optional<geometry::PointIndex> present_index_;
    std::vector<std::optional<std::optional<double>>> curvatures_;
    std::optional<std::vector<double>> reverse_mm_;
};

}  // namespace mimik::evaluation
