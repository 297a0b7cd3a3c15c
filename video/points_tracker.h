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
    [[nodiscard]] virtual std::optional<Points68> points(const io::Image& frame, const FaceBox& face) = 0;
};

/// A tracker from points in the box of a face: between two looks of the finder the box goes with the eyes, and a face
/// that is no longer like itself is looked for at once.
[[nodiscard]] std::unique_ptr<FeatureTracker> make_points_tracker(std::unique_ptr<PointSource> source,
                                                                  const FaceChoiceOptions& choice = {});

}  // namespace mimik::video
