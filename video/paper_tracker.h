#pragma once

#include <filesystem>
#include <memory>

#include "base/fields.h"
#include "video/curve_fit.h"
#include "video/face_choice.h"
#include "video/face_watch.h"
#include "video/feature_flow.h"
#include "video/feature_tracker.h"

namespace mimik::video {

struct PaperTrackerOptions {
    CurveFitOptions fit = {};
    FlowOptions flow = {};
    FaceChoiceOptions face = {};
    FaceWatchOptions watch = {};
    double least_contrast = 0.16;  ///< of all features of a face that is taken for one; skin alone has about 0
    double least_inliers = 0.3;    ///< share of the points of the head that must move as one
    /// Of the lips alone, when a face is found: a covered mouth has none.
    double least_lip_contrast = video::least_lip_contrast;
    int look_every_frames = 5;  ///< the face finder looks whether there is still a face
    int misses = 6;             ///< so many frames on end it does not: the face is lost
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("fit", self.fit);
        visit("flow", self.flow);
        visit("face", self.face);
        visit("watch", self.watch);
        visit("least_contrast", self.least_contrast);
        visit("least_inliers", self.least_inliers);
        visit("least_lip_contrast", self.least_lip_contrast);
        visit("look_every_frames", self.look_every_frames);
        visit("misses", self.misses);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<PaperTrackerOptions>());

class ColourNetwork;

/// The tracker of Sec. 3: colour transform, blobs, Bezier snakes. A face that is lost is looked for in every frame.
/// @param network  estimates the weights of Eq. 1 from the face's own colours, once when it is found
[[nodiscard]] std::unique_ptr<FeatureTracker> make_paper_tracker(std::shared_ptr<const ColourNetwork> network = {},
                                                                 const PaperTrackerOptions& options = {});

}  // namespace mimik::video
