#pragma once

#include <filesystem>
#include <memory>

#include "video/face_choice.h"
#include "video/feature_tracker.h"

namespace mimik::video {

/// The 68 points of a net that the user gives (video/landmark_net.h). It is shown the square of the face finder, made
/// 1.2 times as wide about its middle, upright; from then on the square that goes with the eyes.
/// @throws InputError as LandmarkNet, and if there is no face finder
[[nodiscard]] std::unique_ptr<FeatureTracker> make_onnx_tracker(const std::filesystem::path& onnx,
                                                                const FaceChoiceOptions& choice = {});

}  // namespace mimik::video
