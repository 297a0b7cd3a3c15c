#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/fields.h"
#include "capture/marker_sequence.h"
#include "geometry/landmarks.h"
#include "geometry/radial_basis_map.h"

namespace mimik::capture {

struct RetargetOptions {
    geometry::RadialBasisOptions basis = {};
    /// Frame of the relaxed face, as the recording numbers its frames; none: the first in which the most of the
    /// labelled markers are there.
    std::optional<std::int64_t> rest_frame = {};
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("basis", self.basis);
        visit("rest_frame", self.rest_frame);
    }
};
static_assert(base::lists_every_field<RetargetOptions>());

struct Retargeted {
    MarkerSequence markers;  ///< those that are labelled, in the frame of the labels
    std::int64_t rest_frame = 0;
    /// By how much lengths grow on the way, over the whole face (the cube root of the volume's change of the affine
    /// part): the motion is scaled by it, too.
    double scale = 1;
    std::vector<std::string> remarks;
};

/// A recording on another face (Sec. 5.1 of Sanchez et al. 2003): one map of space takes the relaxed frame to the
/// labels, and the same map every other frame. The head's motion should be off (stabilise()).
/// @param labels  where the markers are on the target, by their names in the recording
/// @throws InputError if there is no such frame, or if fewer than four markers are labelled and there at rest;
/// NumericalError if they lie in one plane.
[[nodiscard]] Retargeted retarget(const MarkerSequence& sequence, const geometry::Landmarks& labels,
                                  const RetargetOptions& options = {});

}  // namespace mimik::capture
