#include "base/errors.h"
#include "video/dlib_tracker.h"

namespace mimik::video {

std::unique_ptr<FeatureTracker> make_dlib_tracker(const std::filesystem::path& /*points*/,
                                                  const FaceChoiceOptions& /*choice*/) {
    throw InputError(
        "this build has no tracker of dlib; install libdlib-dev and libdlib-data, configure and build again");
}

}  // namespace mimik::video
