#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "base/fields.h"
#include "geometry/face_axes.h"
#include "geometry/landmarks.h"
#include "geometry/range_scan.h"

namespace mimik::preprocessing {

/// Where a face ends, in outer-eye distances (about 90 mm on an adult) along the head's own axes.
struct FaceCropOptions {
    bool crop = true;  ///< false: all of the scan is kept, neck, ears and shoulders
    /// The average face reaches 0.82, 0.85 and 0.18 in its own frame; on heads of three kinds that is up to 0.87, 0.95
    /// and 0.20 in the head's axes.
    double half_width = 0.95;  ///< to each side of the middle between the outer eye corners
    double above_eyes = 1.0;
    double below_chin = 0.45;  ///< 40 mm: the skin under the chin, which a jaw that drops takes along
    double behind_eyes = 0.9;  ///< deeper than the outer eye corners: the back of the head
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("crop", self.crop);
        visit("half_width", self.half_width);
        visit("above_eyes", self.above_eyes);
        visit("below_chin", self.below_chin);
        visit("behind_eyes", self.behind_eyes);
    }
    /// @throws InputError naming the field and its value.
    void check() const;
};
static_assert(base::lists_every_field<FaceCropOptions>());

/// The box around a face, upright in the head's own axes: a head that is tilted is cropped upright.
struct FaceBox {
    geometry::HeadAxes axes;
    geometry::Point between_eyes_mm;  ///< middle of the outer eye corners; the lengths below start there
    double half_width_mm = 0.0, above_mm = 0.0, below_mm = 0.0, behind_mm = 0.0;

    [[nodiscard]] bool holds(const geometry::Point& point_mm) const;
};

/// Needs eye corners, mouth corners, nose tip and chin; without one of them there is no box.
/// @param lacking  why there is none
/// @throws InputError for bad options.
[[nodiscard]] std::optional<FaceBox> face_box(const geometry::Landmarks& landmarks, const FaceCropOptions& options = {},
                                              std::string* lacking = nullptr);

/// What a crop left out.
struct FaceCropReport {
    std::size_t points = 0;    ///< measured points that came in
    std::size_t left_out = 0;  ///< points outside the box
    std::size_t faces_left_out = 0;
};

/// The points of a scan that lie in the box, and the faces of which all corners do. In an organised scan the others
/// become NaN; a cloud or mesh loses them. A scan that lies in the box comes back as it is.
/// @throws InputError if fewer than three points are left.
[[nodiscard]] geometry::RangeScan crop_to_face(const geometry::RangeScan& scan, const FaceBox& box,
                                               FaceCropReport* report = nullptr);

}  // namespace mimik::preprocessing
