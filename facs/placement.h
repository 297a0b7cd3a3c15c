#pragma once

#include <string>
#include <utility>
#include <vector>

#include "facs/side.h"
#include "geometry/landmarks.h"
#include "geometry/types.h"

namespace mimik::facs {

/// A place relative to landmarks, written for the subject's left side: sum of weight * landmark, plus an offset in
/// outer-eye distances. A landmark name without a side ("mouth_corner") means that of the side asked for.
struct Placement {
    std::vector<std::pair<std::string, double>> at;
    double lateral = 0.0;  ///< away from the midline
    double up = 0.0;
};

/// Whether its landmarks all stand on the midline and it has no lateral offset: it stands once.
[[nodiscard]] bool on_midline(const Placement& placement);
/// The landmarks of a placement on one side that a face lacks, by names that landmarks have.
[[nodiscard]] std::vector<std::string> missing_marks(const Placement& placement, const geometry::Landmarks& landmarks,
                                                     Side side);
/// Position of a placement on one side (left or right). @throws InputError naming a landmark that is missing.
[[nodiscard]] geometry::Point place(const Placement& placement, const geometry::Landmarks& landmarks, Side side);

/// "_left" or "_right": the end of the names of points and landmarks of one side.
[[nodiscard]] const char* side_suffix(Side side);

}  // namespace mimik::facs
