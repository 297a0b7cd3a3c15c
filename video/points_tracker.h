#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "video/face_choice.h"
#include "video/feature_tracker.h"

namespace mimik::video {

/// Finds faces, and the 68 points of one: what a tracker from elsewhere has to do.
class PointSource {
public:
    virtual ~PointSource() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    /// All faces of a frame, the largest first.
    [[nodiscard]] virtual std::vector<FaceBox> find(const io::Image& frame) = 0;
    /// Pixels of the frame, the middle of its first one (0, 0), in the order of iBUG's 300-W: the outer corner of the
    /// subject's right eye is 36, of the left 45. None if the source gives no points there.
    /// @param face  a box of find(), or one that has moved on with the face since then
    [[nodiscard]] virtual std::optional<Points68> points(const io::Image& frame, const FaceBox& face) = 0;
};

/// A tracker from points in the box of a face: between two looks of the finder the box goes with the eyes, and a face
/// that is no longer like itself is looked for at once. Of the boxes that may be the performer's the first is taken in
/// which lips are seen.
/// @throws InputError for a bad choice; next() throws it for a pixel that frames do not have
[[nodiscard]] std::unique_ptr<FeatureTracker> make_points_tracker(std::unique_ptr<PointSource> source,
                                                                  const FaceChoiceOptions& choice = {});

}  // namespace mimik::video
