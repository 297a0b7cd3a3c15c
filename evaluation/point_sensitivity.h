#pragma once

#include <functional>
#include <string>
#include <vector>

#include "animation/model_method.h"
#include "base/fields.h"
#include "evaluation/tune_points.h"
#include "facs/facs_catalogue.h"

namespace mimik::evaluation {

struct PointSensitivityOptions {
    double step_mm = 1.0;  ///< how far a point is moved, on the reference face

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("step_mm", self.step_mm);
    }
    void check() const;  ///< throws InputError
};
static_assert(base::lists_every_field<PointSensitivityOptions>());

/// What one point's place does to the error of its AU.
struct PointSensitivity {
    std::string name;
    facs::ControlKind kind = facs::ControlKind::muscle;
    bool midline = false;  ///< it has no sideways moves
    /// Mean error after the point was moved by the step, less that before, mm: above 0 the move does harm. Both sides
    /// of the face move alike; outward is away from the midline.
    double outward_mm = 0, inward_mm = 0, up_mm = 0, down_mm = 0;

    /// The largest change by any of the moves, whatever its sign.
    [[nodiscard]] double largest_mm() const;
};

struct UnitSensitivity {
    int unit = 0;
    std::size_t cases = 0;
    double error_mm = 0, nothing_mm = 0;  ///< mean over the cases, in the zone, with the points as they are
    double step_mm = 0;
    std::vector<PointSensitivity> points;  ///< in the catalogue's order
};

/// "Moving this point by 1 mm changes the error of AU 12 by so much": the source on itself, as tune_points() has it
/// (both sides of the face at once; every vertex of the AU's zone counts), each point moved alone.
///
/// Parallel over subjects; the same answer for any number of threads.
/// @param method  its points stand on the source: "thesis"
/// @param failures  subjects that cannot take part, with the reason
/// @param done  told after each move that was tried
/// @throws InputError for bad options, an AU that is not in the catalogue or has no points, or if no subject shows it.
[[nodiscard]] UnitSensitivity point_sensitivity(const TuneGroup& group, const facs::FacsCatalogue& catalogue, int unit,
                                                const animation::ModelMethod& method,
                                                const PointSensitivityOptions& options, FailureList& failures,
                                                const std::function<void()>& done = {});

}  // namespace mimik::evaluation
