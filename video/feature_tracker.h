#pragma once

#include <memory>
#include <optional>
#include <string>

#include "io/image.h"
#include "video/face_curves.h"
#include "video/face_patch.h"

namespace mimik::video {

/// What a tracker saw in one frame. Nothing is said of a face that it does not see.
struct TrackedFace {
    FaceCurves curves;  ///< pixels of the frame
    FacePlace place;
    double confidence = 0;    ///< 0 to 1
    bool found_anew = false;  ///< not carried on from the frame before
    /// All 68 points, from trackers that have them; else those on curves come from the curves, the others from the
    /// fitted head (video/head_pose.h).
    std::optional<Points68> points;
};

/// Follows one face from frame to frame.
class FeatureTracker {
public:
    virtual ~FeatureTracker() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    /// @returns the face, or nothing if it is lost or there is none; of several faces the largest
    [[nodiscard]] virtual std::optional<TrackedFace> next(const io::Image& frame) = 0;
    /// Forgets what was: the next frame is looked at as the first.
    virtual void restart() = 0;
};

}  // namespace mimik::video
