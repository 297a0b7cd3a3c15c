#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/bounded_median.h"
#include "geometry/quad_grid.h"
#include "geometry/surface_index.h"
#include "geometry/types.h"

namespace mimik::evaluation {

/// Everything about one target that all methods share.
struct ScoredTarget {
    std::vector<std::uint32_t> vertices;  ///< scored: measured, and doing nothing does not hit the border
    std::vector<char> in_zone;            ///< parallel to `vertices`
    std::vector<double> nothing_mm;       ///< parallel to `vertices`
    std::vector<geometry::Vector>
        true_displacement_mm;                          ///< parallel to `vertices`, scanner frame; empty without a truth
    std::optional<geometry::SurfaceIndex> expressive;  ///< the real expressive scan, in the neutral's scanner frame
};

/// The measured vertices of `neutral` that see the real expressive scan, and what doing nothing scores there.
/// @param zone  per vertex of `neutral`: 1 in the active zone, as carry_zone
/// @throws InputError if the expressive scan has no surface.
[[nodiscard]] ScoredTarget scored_target(const geometry::QuadGrid& neutral, const geometry::QuadGrid& expressive,
                                         const geometry::Transform& neutral_from_expressive,
                                         const std::vector<char>& zone);

/// One method on one case; means over the scored vertices.
struct CaseResult {
    double zone_mm = 0, zone_nothing_mm = 0, whole_mm = 0, whole_nothing_mm = 0;
    double true_mm = -1, true_nothing_mm = -1;
    std::optional<double> step_mm;  ///< largest crack of an animated face; a true field or no answer has none
    std::size_t left_out = 0;
};

/// One method on one expression.
struct Score {
    double explained = 0.0;         ///< 1 - sum err(method) / sum err(doing nothing), active zone
    double explained_median = 0.0;  ///< of 1 - err / err(nothing) over the cases
    double explained_whole = 0.0;   ///< the same over the whole face
    double error_mm = 0.0;          ///< mean over cases
    double nothing_mm = 0.0;
    double true_error_mm = -1.0;  ///< mean 3D distance to the true position of the same material point; -1: no truth
    double nothing_true_mm = -1.0;
    std::optional<double> largest_step_mm;  ///< largest crack between neighbouring vertices, mean over cases with one
    std::size_t cases = 0;
    std::size_t worse_than_nothing = 0;
    std::size_t left_out_vertices = 0;  ///< scored as doing nothing
};

/// Distance of an animated face to the real expressive scan, and to the truth where it is known. A vertex whose
/// position or displacement is not finite was left out by the method and counts with the error of doing nothing, in
/// both.
/// @param animated_mm      one per vertex of the target's grid, scanner frame; NaN: no answer
/// @param displacement_mm  the same, from the neutral face
/// @param grid             the neutral face
/// @throws NumericalError if no scored vertex is in the zone: 0 mm against 0 mm would be no score.
[[nodiscard]] CaseResult judge_case(const ScoredTarget& target, const std::vector<geometry::Point>& animated_mm,
                                    const std::vector<geometry::Vector>& displacement_mm,
                                    const geometry::QuadGrid& grid, bool whole_face);

/// Sums the cases of one method on one expression, one after another; holds no case.
class ScoreSum {
public:
    void add(const CaseResult& result);
    [[nodiscard]] Score score() const;

private:
    Score sums_;  // its counts
    double error_ = 0, nothing_ = 0, whole_ = 0, whole_nothing_ = 0, true_error_ = 0, true_nothing_ = 0, steps_ = 0;
    std::size_t with_truth_ = 0, with_step_ = 0;
    BoundedMedian explained_;
};

}  // namespace mimik::evaluation
