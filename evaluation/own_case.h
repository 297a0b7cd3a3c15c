#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "animation/animate.h"
#include "animation/model_method.h"
#include "evaluation/active_zone.h"
#include "evaluation/performance.h"
#include "evaluation/tune_points.h"
#include "facs/facs_catalogue.h"
#include "geometry/surface_index.h"

namespace mimik::evaluation {

/// One scan of an expression, made ready to be put on its own neutral face again and again, with points of a catalogue
/// that move.
class OwnCase {
public:
    /// @throws NumericalError if no vertex of the zone sees the expressive scan.
    OwnCase(const PerformanceReader& reader, const database::ScanId& scan, const ActiveZone& zone,
            const animation::ModelMethod& method, std::size_t most_vertices);

    struct Errors {
        double own_mm = 0, nothing_mm = 0;
    };
    /// With the points of a catalogue. @param whole_zone  else no more than most_vertices of it
    [[nodiscard]] Errors errors(const facs::FacsCatalogue& catalogue, const animation::ModelMethod& method,
                                bool whole_zone) const;
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
    database::ScanId scan;
    std::shared_ptr<const ActiveZone> zone;
};

/// The scans of one expression by subjects of a workspace, with the zone that all its subjects show.
[[nodiscard]] std::vector<PlannedCase> planned_cases(const TuneGroup& group, const facs::FacsCatalogue& catalogue,
                                                     const facs::Expression& expression, FailureList& failures);
/// Empty, and a failure, where the scan gives none.
[[nodiscard]] std::unique_ptr<const OwnCase> ready_case(const PlannedCase& planned,
                                                        const animation::ModelMethod& method, std::size_t most_vertices,
                                                        FailureList& failures);

/// The catalogue with this unit alone: what is copied for every step.
[[nodiscard]] facs::FacsCatalogue unit_alone(const facs::FacsCatalogue& catalogue, const facs::ActionUnit& unit);

/// @throws InputError if a method's points do not stand on the source.
void require_points_on_source(const animation::ModelMethod& method);

}  // namespace mimik::evaluation
