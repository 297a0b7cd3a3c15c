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

/// What the distance to the real scan hardly sees, of one method on one expression or of the mean of its expressions;
/// what is not known is empty.
struct Faults {
    std::optional<double> lip_aperture_error_mm;  ///< median over cases of |aperture of the lips - the real scan's|
    std::optional<double> still_skin_mm;          ///< mean motion of skin that should hold still, mean over cases
    std::optional<double> peak_ratio;             ///< sum of the peaks of motion / sum of the true peaks
    std::optional<double> lips_over_hole;  ///< vertices of the lips over a hole of the real scan, mean over cases
    std::optional<double> face_over_hole;  ///< the same of all measured vertices

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("lip_aperture_error_mm", self.lip_aperture_error_mm);
        visit("still_skin_mm", self.still_skin_mm);
        visit("peak_ratio", self.peak_ratio);
        visit("lips_over_hole", self.lips_over_hole);
        visit("face_over_hole", self.face_over_hole);
    }
    bool operator==(const Faults&) const = default;
};

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
    Faults faults = {};
};

/// Which rows make a score. A source that is its own target never stands beside others in a mean: it knows its face.
enum class Pairs {
    of_two,           ///< source and target are two people, or there is no source
    source_on_itself  ///< source and target are one; doing nothing as ever
};

/// By method (variant_of: "mean", "mean@0.8"), then by expression.
using ScoreTable = std::map<std::string, std::map<std::string, Score>>;

/// A pure function of rows: `read` hands them over in the order in which they were stored, those of one case one after
/// another and "nothing" before the other methods of its target. Sums are made in that order. Rows of the other kind
/// of pairs are passed over.
[[nodiscard]] ScoreTable scores_of(const std::function<void(const std::function<void(const CaseRow&)>&)>& read,
                                   Pairs pairs = Pairs::of_two);

}  // namespace mimik::evaluation
