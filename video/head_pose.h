#pragma once

#include <array>
#include <optional>

#include "base/fields.h"
#include "capture/feature_motion.h"
#include "video/face_curves.h"

namespace mimik::video {

/// A camera without distortion whose principal point is the middle of the image.
struct CameraOptions {
    double focal_of_width = 1.2;               ///< focal length as a share of the image's width: 45 degrees across
    std::optional<double> outer_eyes_mm = {};  ///< the performer's; none: the mean face's, 87.3 mm
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("focal_of_width", self.focal_of_width);
        visit("outer_eyes_mm", self.outer_eyes_mm);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<CameraOptions>());

/// Which of the 68 points a tracker gives.
using Known68 = std::array<bool, 68>;
/// Those that lie on curves (places_on_curves()).
[[nodiscard]] const Known68& known_on_curves();

/// The performer's head as points: the mean face's, moved to what one neutral frame shows. The depth of a point, which
/// one camera does not see, stays the mean face's.
class FittedHead {
public:
    /// @param neutral  the points, in pixels, of a neutral face that looks into the camera; its head may be tilted
    FittedHead(const Points68& neutral, const Known68& known, int image_width, int image_height,
               const CameraOptions& options = {});

    /// From the corners of the eyes and the row under the nose, which expressions move least. None if the numbers
    /// allow no pose with the face before the camera. @param start  the last frame's pose, if there is one
    [[nodiscard]] std::optional<capture::HeadPose> pose(const Points68& points,
                                                        const std::optional<capture::HeadPose>& start) const;
    /// Where the ray through a pixel meets the plane of the head in which point k lies: frame of the head, mm.
    [[nodiscard]] geometry::Point head_point_mm(std::size_t k, const Pixel& at, const capture::HeadPose& pose) const;
    /// The points that the tracker does not know, as the head has them; those of the chin go down with the lower lip.
    void fill(Points68& points, const Known68& known, const capture::HeadPose& pose) const;
    [[nodiscard]] Pixel project(const geometry::Point& head_mm, const capture::HeadPose& pose) const;
    [[nodiscard]] const std::array<geometry::Point, 68>& points_mm() const { return points_mm_; }

private:
    std::array<geometry::Point, 68> points_mm_;
    double focal_px_ = 0, centre_x_ = 0, centre_y_ = 0;
};

}  // namespace mimik::video
