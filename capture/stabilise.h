#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/fields.h"
#include "capture/marker_sequence.h"
#include "geometry/types.h"

namespace mimik::capture {

struct StabiliseOptions {
    /// Markers on a jig that moves with the skull: they alone say how the head moves (Sec. 5.1 of Sanchez et al. 2003).
    /// Empty: a robust fit over `by`.
    std::vector<std::string> jig = {};
    /// Markers of the face for the robust fit; empty: all. Those that move with an expression lose their say.
    std::vector<std::string> by = {};
    /// Residuals of the robust fit count as noise down to this; below it no marker loses its say. Optical systems are
    /// good to a few tenths of a millimetre.
    double noise_mm = 0.3;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("jig", self.jig);
        visit("by", self.by);
        visit("noise_mm", self.noise_mm);
    }
    /// @throws InputError if the noise is not positive and finite, or if both lists are given.
    void check() const;
};
static_assert(base::lists_every_field<StabiliseOptions>());

/// A sequence in the pose of its rest frame.
struct Stabilised {
    MarkerSequence markers;                            ///< all of them, those of the jig, too
    std::size_t rest_frame = 0;                        ///< the first in which all markers that the fit uses are there
    std::vector<geometry::Transform> rest_from_frame;  ///< identity where it is unknown
    /// How far the markers that the fit used are from their rest (root mean square, by their weights); empty: the
    /// pose is unknown, and all samples of the frame are missing.
    std::vector<std::optional<double>> residual_mm;
    std::vector<std::string> remarks;
};

/// Takes the motion of the head off: brings every frame rigidly to the rest frame, by the jig, or else by the markers
/// that move least (iteratively reweighted least squares, Tukey's biweight with the scale from the median of the
/// residuals). A frame in which fewer than three of them are there, or all on one line, has no pose.
/// @throws InputError naming a marker that there is not; NumericalError if no frame has three of them off one line.
[[nodiscard]] Stabilised stabilise(const MarkerSequence& sequence, const StabiliseOptions& options = {});

}  // namespace mimik::capture
