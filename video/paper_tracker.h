#pragma once

#include <filesystem>
#include <memory>

#include "base/fields.h"
#include "video/curve_fit.h"
#include "video/feature_flow.h"
#include "video/feature_tracker.h"

namespace mimik::video {

struct PaperTrackerOptions {
    CurveFitOptions fit = {};
    FlowOptions flow = {};
    double least_contrast = 0.16;  ///< of all features of a face that is taken for one; skin alone has about 0
    double least_inliers = 0.3;    ///< share of the points of the head that must move as one
    int look_every_frames = 5;     ///< the face finder looks whether there is still a face
    int misses = 4;                ///< so many times it does not: the face is lost
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("fit", self.fit);
        visit("flow", self.flow);
        visit("least_contrast", self.least_contrast);
        visit("least_inliers", self.least_inliers);
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
