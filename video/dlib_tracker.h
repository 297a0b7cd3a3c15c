#pragma once

#include <filesystem>
#include <memory>

#include "video/face_choice.h"
#include "video/feature_tracker.h"

namespace mimik::video {

/// dlib's 68 points (Kazemi and Sullivan 2014) in the boxes of its face detector. Debian's packages
/// libdlib-dev and libdlib-data have them. The points were learnt from the iBUG 300-W pictures, which may not be used
/// commercially.
/// @param points  the shape predictor; empty: that of libdlib-data
/// @throws InputError if the file is missing or no shape predictor, or if Mimik was built without dlib
[[nodiscard]] std::unique_ptr<FeatureTracker> make_dlib_tracker(const std::filesystem::path& points = {},
                                                                const FaceChoiceOptions& choice = {});

}  // namespace mimik::video
