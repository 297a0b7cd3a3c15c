#include "cli/tracker_choice.h"

#include "cli/command.h"
#include "video/colour_network.h"
#include "video/dlib_tracker.h"
#include "video/onnx_tracker.h"
#include "video/paper_tracker.h"

namespace mimik::cli {

std::unique_ptr<video::FeatureTracker> make_tracker(const TrackingArguments& arguments) {
    const auto asked = face_choice(arguments.face);
    video::FaceChoiceOptions choice;
    choice.rank = asked.rank;
    if (asked.pixel) {
        choice.x_px = (*asked.pixel)[0];
        choice.y_px = (*asked.pixel)[1];
    }
    if (arguments.tracker == "dlib") return video::make_dlib_tracker({}, choice);
    if (arguments.tracker == "onnx") return video::make_onnx_tracker(arguments.model, choice);
    auto network =
        arguments.colours.empty() ? video::ColourNetwork::shipped() : video::ColourNetwork::load(arguments.colours);
    video::PaperTrackerOptions options;
    options.face = choice;
    return video::make_paper_tracker(std::make_shared<const video::ColourNetwork>(std::move(network)), options);
}

video::TrackVideoOptions track_options(const TrackingArguments& arguments, long most_frames) {
    video::TrackVideoOptions options;
    const auto neutral = neutral_frames(arguments.neutral);
    options.neutral_from = neutral[0];
    options.neutral_to = neutral[1];
    options.smooth = arguments.smooth;
    options.most_frames = most_frames;
    options.camera.outer_eyes_mm = arguments.interocular_mm;
    check_by_option({{"outer_eyes_mm", "--interocular-mm"}, {"most_frames", "--frames"}}, [&] { options.check(); });
    return options;
}

}  // namespace mimik::cli
