#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "base/fields.h"
#include "capture/feature_motion.h"
#include "io/image.h"
#include "video/face_curves.h"

namespace mimik::video {

/// A made performance whose truth is known: a person of the built-in face model acts before a camera.
struct PerformanceOptions {
    int width_px = 640;
    int height_px = 480;
    double rate_hz = 30;
    int frames = 300;
    std::uint64_t seed = 1;      ///< who acts, and what they do
    double expression = 1;       ///< scales the weights of all motions; 0: a face at rest
    double head_motion = 1;      ///< 1: turns of up to 12 degrees and shifts of up to 25 mm; 0: a head that is still
    double light_change = 0.25;  ///< share by which the light grows and falls in the performance
    double noise = 2;            ///< standard deviation of the camera's noise, grey levels of 255
    double distance_mm = 550;    ///< from the camera to the face; further away it is smaller
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("width_px", self.width_px);
        visit("height_px", self.height_px);
        visit("rate_hz", self.rate_hz);
        visit("frames", self.frames);
        visit("seed", self.seed);
        visit("expression", self.expression);
        visit("head_motion", self.head_motion);
        visit("light_change", self.light_change);
        visit("noise", self.noise);
        visit("distance_mm", self.distance_mm);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<PerformanceOptions>());

/// What is true of one frame.
struct PerformanceTruth {
    double time_s = 0;
    std::map<std::string, double> weights;  ///< of the model's shapes (synthesis/face_model.h), 0 to 1
    capture::HeadPose camera_from_head;     ///< head frame: origin in the middle between the resting outer eye corners
    /// Curves through vertices of the skin, each a row of points in pixels.
    std::array<std::vector<Pixel>, curve_count> curves;
    Points68 points;
};

class RenderedPerformance {
public:
    /// Builds the person within some seconds. @throws InputError as PerformanceOptions::check.
    explicit RenderedPerformance(const PerformanceOptions& options = {});
    ~RenderedPerformance();

    /// Any frame in any order: each is made from the seed and its number alone.
    [[nodiscard]] io::Image image(int frame) const;
    [[nodiscard]] PerformanceTruth truth(int frame) const;
    /// Distance of the outer eye corners of the resting face.
    [[nodiscard]] double outer_eyes_mm() const;
    /// Of the camera: focal length in pixels; the principal point is the middle of the image.
    [[nodiscard]] double focal_px() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace mimik::video
