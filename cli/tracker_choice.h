#pragma once

#include <memory>

#include "cli/capture_options.h"
#include "video/feature_tracker.h"
#include "video/track_video.h"

namespace mimik::cli {

/// A tracker refuses the pixel of --face when it has seen how large frames are.
inline const OptionOfField option_of_pixel = {{"x_px,", "--face"}};

/// The tracker that --tracker, --model, --colours and --face ask for.
[[nodiscard]] std::unique_ptr<video::FeatureTracker> make_tracker(const TrackingArguments& arguments);

/// What --neutral, --smooth, --interocular-mm and --frames say, checked.
[[nodiscard]] video::TrackVideoOptions track_options(const TrackingArguments& arguments, long most_frames);

}  // namespace mimik::cli
