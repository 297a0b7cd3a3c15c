#include "preprocessing/face_crop.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/leave_out_points.h"

namespace mimik::preprocessing {

using geometry::Landmarks;
using geometry::Point;
using geometry::RangeScan;
using geometry::Vector;

void FaceCropOptions::check() const {
    // The mouth is 0.3 outer-eye distances from the middle, the brows 0.25 above the eyes, the ears 0.9 behind them.
    base::each_field(*this, [](const std::string_view name, const auto value) {
        if (name == "crop") return;
        const double least = name == "below_chin" ? 0.0 : 0.3;
        if (!(static_cast<double>(value) >= least) || !std::isfinite(static_cast<double>(value)))
            throw InputError(
                fmt::format("{} of the crop is {} outer-eye distances; give {} or more", name, value, least));
    });
}

namespace {

std::string lacking_of(const Landmarks& marks, const std::optional<geometry::HeadAxes>& axes) {
    for (const char* name : {"eye_outer_left", "eye_outer_right", "eye_inner_left", "eye_inner_right",
                             "mouth_corner_left", "mouth_corner_right", "nose_tip", "chin"})
        if (!marks.find(name)) return fmt::format("landmark '{}' is missing", name);
    return axes ? std::string() : "eye corners, mouth corners and nose tip lie on one line";
}

}  // namespace

bool FaceBox::holds(const Point& point_mm) const {
    const Vector from_eyes_mm = point_mm - between_eyes_mm;
    const double up_mm = axes.up.dot(from_eyes_mm);
    return std::abs(axes.lateral.dot(from_eyes_mm)) <= half_width_mm && up_mm <= above_mm && up_mm >= -below_mm &&
           axes.out.dot(from_eyes_mm) >= -behind_mm;
}

std::optional<FaceBox> face_box(const Landmarks& landmarks, const FaceCropOptions& options, std::string* lacking) {
    options.check();
    const auto axes = geometry::head_axes(landmarks);
    if (const auto reason = lacking_of(landmarks, axes); !reason.empty()) {
        if (lacking) *lacking = reason;
        return std::nullopt;
    }
    const Point between_eyes_mm =
        0.5 * (landmarks.position_mm("eye_outer_left") + landmarks.position_mm("eye_outer_right"));
    const double eyes_mm = geometry::outer_eye_distance_mm(landmarks);
    const double chin_below_mm = axes->up.dot(between_eyes_mm - landmarks.position_mm("chin"));
    return FaceBox{*axes,
                   between_eyes_mm,
                   options.half_width * eyes_mm,
                   options.above_eyes * eyes_mm,
                   chin_below_mm + options.below_chin * eyes_mm,
                   options.behind_eyes * eyes_mm};
}

RangeScan crop_to_face(const RangeScan& scan, const FaceBox& box, FaceCropReport* report) {
    FaceCropReport counts;
    geometry::VertexMask outside(scan.points_mm.size(), 0);
    for (std::size_t i = 0; i < outside.size(); ++i) {
        if (!scan.valid(i)) continue;
        ++counts.points;
        outside[i] = box.holds(scan.points_mm[i]) ? 0 : 1;
        counts.left_out += outside[i];
    }
    if (counts.points < counts.left_out + 3)
        throw InputError(
            fmt::format("{} of {} points lie outside the face that the landmarks mark; give landmarks of this scan in "
                        "its unit, or keep all of it",
                        counts.left_out, counts.points));
    auto face = counts.left_out == 0 ? scan : geometry::leave_out_points(scan, outside);
    counts.faces_left_out = scan.faces.size() - face.faces.size();
    if (report) *report = counts;
    return face;
}

}  // namespace mimik::preprocessing
