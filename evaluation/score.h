#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/case_row.h"

namespace mimik::evaluation {

/// What every other method has to beat, by its name.
inline constexpr const char* baseline_method = "nothing";

/// An expressive scan that lies nearer to its neutral is the same scan: there is nothing to explain. No scanner comes
/// near it, and rounding stays far below.
inline constexpr double least_motion_mm = 1e-4;

/// One method on one expression; what is not known is empty.
struct Score {
    /// 1 - sum err(method) / sum err(doing nothing), active zone; empty below least_motion_mm.
    std::optional<double> explained;
    std::optional<double> explained_median;  ///< of 1 - err / err(nothing) over the cases
    std::optional<double> explained_whole;   ///< the same over the whole face
    std::optional<double> error_mm;          ///< mean over cases
    std::optional<double> nothing_mm;
    std::optional<double> true_error_mm;  ///< mean 3D distance to the true position of the same skin point
    std::optional<double> nothing_true_mm;
    std::optional<double> largest_step_mm;  ///< largest crack between neighbouring vertices, mean over cases with one
    std::size_t cases = 0;
    std::size_t worse_than_nothing = 0;
    std::size_t left_out_vertices = 0;  ///< scored as doing nothing
};

/// By method, then by expression.
using ScoreTable = std::map<std::string, std::map<std::string, Score>>;

/// A pure function of rows: `read` hands them over in the order in which they were stored, those of one case one after
/// another and "nothing" before the other methods of its target. Sums are made in that order.
[[nodiscard]] ScoreTable scores_of(const std::function<void(const std::function<void(const CaseRow&)>&)>& read);

}  // namespace mimik::evaluation
