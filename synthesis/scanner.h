#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/landmarks.h"
#include "geometry/range_scan.h"
#include "synthesis/face_model.h"

namespace mimik::synthesis {

/// The synthetic scanner: a structured-light range camera in front of the face, and the person who marks landmarks.
struct ScannerOptions {
    double spacing_mm = 0.77;            ///< of the lattice in x and y
    double noise_z_mm = 0.13;            ///< standard deviation, independent per point
    double smooth_noise_z_mm = 0.05;     ///< standard deviation of a smooth error
    double smooth_noise_length_mm = 6;   ///< its correlation length: a few fringe widths
    double noise_xy_mm = 0.03;           ///< standard deviation, independent per point
    double min_normal_z = 0.22;          ///< surfaces that turn away more than this are lost (13 degrees of grazing)
    double pitch_deg = 3.0;              ///< standard deviation of the nod
    double yaw_deg = 3.0;                ///< of the turn
    double roll_deg = 1.5;               ///< of the tilt
    double translation_mm = 6.0;         ///< of each coordinate of where the head is
    double eye_hole_share = 0.6;         ///< share of eyes and lids that is lost, in patches
    double nostril_hole_share = 0.8;     ///< share of the nostrils' rim
    double brow_hole_share = 0.2;        ///< share of the brows (dark hair)
    int spikes = 0;                      ///< outliers of 5 to 40 mm per scan
    int stray_parts = 0;                 ///< patches of cloth or hair beside or below the face per scan
    double marking_jitter = 1.0;         ///< scales the marking error, 0.5 (eye corners) to 1.0 mm (brows, chin) rms
    double texture_pixels_per_mm = 2.0;  ///< of the photograph

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("spacing_mm", self.spacing_mm);
        visit("noise_z_mm", self.noise_z_mm);
        visit("smooth_noise_z_mm", self.smooth_noise_z_mm);
        visit("smooth_noise_length_mm", self.smooth_noise_length_mm);
        visit("noise_xy_mm", self.noise_xy_mm);
        visit("min_normal_z", self.min_normal_z);
        visit("pitch_deg", self.pitch_deg);
        visit("yaw_deg", self.yaw_deg);
        visit("roll_deg", self.roll_deg);
        visit("translation_mm", self.translation_mm);
        visit("eye_hole_share", self.eye_hole_share);
        visit("nostril_hole_share", self.nostril_hole_share);
        visit("brow_hole_share", self.brow_hole_share);
        visit("spikes", self.spikes);
        visit("stray_parts", self.stray_parts);
        visit("marking_jitter", self.marking_jitter);
        visit("texture_pixels_per_mm", self.texture_pixels_per_mm);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<ScannerOptions>());

/// What one exposure gives. Scanner frame, mm.
struct SyntheticScan {
    geometry::RangeScan scan;            ///< texture coordinates by the photograph's camera, which looks along -z
    geometry::Landmarks landmarks;       ///< as marked: vertices of the lattice; what was not visible is absent
    geometry::Landmarks true_landmarks;  ///< free of jitter; all of the model's landmarks
    geometry::Transform scanner_from_head = geometry::Transform::Identity();
    std::size_t valid_points = 0;
    std::size_t lost_grazing = 0;  ///< points of the face that turned away too far
    std::size_t lost_holes = 0;    ///< points lost at eyes, nostrils and brows
    int image_width = 0, image_height = 0;
    geometry::Point image_corner_mm = geometry::Point::Zero();  ///< top left corner of the photograph in x and y
};

/// The part of the surface that the scanner keeps: an oval from the hairline to below the chin, placed by eye corners
/// and chin of the resting face. Its lower edge follows a chin that moves down, as the operator of a scanner would.
struct FaceWindow {
    geometry::Point centre_mm = geometry::Point::Zero();
    double half_width_mm = 0, half_height_mm = 0;
    double chin_y_mm = 0;  ///< of the resting face
    /// 0 at the centre, 1 on the border.
    [[nodiscard]] double level(const geometry::Point& head_mm) const;
    /// This window with its lower edge moved down as far as the chin has moved.
    [[nodiscard]] FaceWindow following_chin(double moved_chin_y_mm) const;
};
[[nodiscard]] FaceWindow face_window(const FaceModel& model, const std::vector<geometry::Point>& resting_mm);

/// @param vertices_mm the surface in the head frame
/// @param scan_name names the streams of chance
[[nodiscard]] SyntheticScan scan_face(const FaceModel& model, const std::vector<geometry::Point>& vertices_mm,
                                      const FaceWindow& resting_window, const std::string& scan_name,
                                      std::uint64_t seed, const ScannerOptions& options = {});

}  // namespace mimik::synthesis
