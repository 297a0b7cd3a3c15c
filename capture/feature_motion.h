#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/types.h"

namespace mimik::capture {

/// A feature of a face that is followed in video, and which of the usual 68 points it is.
struct FaceFeature {
    std::string_view name;  ///< sides are the subject's own
    int point68 = 0;        ///< 17 to 26 and 30 to 67: jaw and bridge of the nose say nothing of expressions
};

/// All features there are, 48, in the order of the 68 points. From the subject's right to the left:
///   brows        brow_outer_right brow_outer_middle_right brow_middle_right brow_inner_middle_right brow_inner_right
///                and brow_inner_left ... brow_outer_left
///   nose         nose_tip nose_wing_right nostril_right nose_base nostril_left nose_wing_left
///   eyes         eye_outer_right lid_upper_outer_right lid_upper_inner_right eye_inner_right lid_lower_inner_right
///                lid_lower_outer_right and eye_inner_left lid_upper_inner_left lid_upper_outer_left eye_outer_left
///                lid_lower_outer_left lid_lower_inner_left
///   outer lips   mouth_corner_right upper_lip_outer_side_right upper_lip_outer_peak_right upper_lip_outer
///                upper_lip_outer_peak_left upper_lip_outer_side_left mouth_corner_left lower_lip_outer_side_left
///                lower_lip_outer_peak_left lower_lip_outer lower_lip_outer_peak_right lower_lip_outer_side_right
///   inner lips   mouth_corner_inner_right upper_lip_inner_right upper_lip_inner upper_lip_inner_left
///                mouth_corner_inner_left lower_lip_inner_left lower_lip_inner lower_lip_inner_right
[[nodiscard]] std::span<const FaceFeature> face_features();
/// Place in face_features(); none if there is no such feature.
[[nodiscard]] std::optional<std::size_t> find_face_feature(std::string_view name);
/// Place in face_features() of one of the 68 points; none for jaw and bridge of the nose.
[[nodiscard]] std::optional<std::size_t> feature_of_point68(int point);

/// Where a feature was in one frame.
struct FeatureSample {
    bool valid = false;     ///< it was seen, and `head_mm` is known
    bool in_image = false;  ///< `pixel` is known, too
    /// Of the original frame: origin at the top left corner of the image, u to the right, v down, pixel centres at .5.
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    /// In the frame of the head, mm: +x the subject's left, +y up, +z out of the face; the origin lies in the middle
    /// between the outer eye corners of the neutral face.
    geometry::Point head_mm = geometry::Point::Zero();
};

/// x_camera = R x_head + t. The camera's frame is OpenCV's: +x to the right of the image, +y down, +z away from it.
struct HeadPose {
    Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< axis times angle, rad
    Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
};

enum class TrackState : std::uint8_t { lost, tracked };
[[nodiscard]] constexpr const char* to_string(TrackState state) {
    return state == TrackState::tracked ? "tracked" : "lost";
}

struct FeatureFrame {
    double time_s = 0.0;  ///< from the start of the video; grows from frame to frame
    TrackState state = TrackState::lost;
    double confidence = 0.0;  ///< 0 to 1
    std::optional<HeadPose> camera_from_head;
    std::vector<FeatureSample> features;  ///< one per name of the motion; none is valid in a frame that is lost
};

/// Features of one face, frame after frame.
struct FeatureMotion {
    std::vector<std::string> names;  ///< of face_features(), any of them, in any order, each once
    double rate_hz = 30.0;           ///< frames a second, as the video says
    std::vector<FeatureFrame> frames;

    /// Place of a feature in `names`; none if this motion does not have it.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
    /// @throws InputError naming frame, feature and value of what breaks one of the rules above.
    void check() const;
};

/// What `motion.csv` holds, schema 1:
///
///     # mimik motion, schema 1, rate_hz 30
///     frame,time,state,confidence,rx,ry,rz,tx,ty,tz,NAME_u,NAME_v,NAME_x,NAME_y,NAME_z,...
///
/// One row per frame from 0 on: `time` in s, `state` tracked or lost, `confidence` 0 to 1, the head's rotation vector
/// in rad and its translation in mm (all six empty: not known), and for every feature its pixel and its position in
/// the head's frame in mm (empty: not valid, or not in an image). Numbers read back as they were.
[[nodiscard]] std::string encode_feature_motion(const FeatureMotion& motion);
/// @param name  stands for the file in errors. Memory goes with the length of the text.
/// @throws InputError naming file, line, column, value and mend.
[[nodiscard]] FeatureMotion decode_feature_motion(std::string_view text, const std::string& name);

void write_feature_motion(const std::filesystem::path& file, const FeatureMotion& motion);
[[nodiscard]] FeatureMotion read_feature_motion(const std::filesystem::path& file);

/// The same table a row at a time, for whoever tracks hours and keeps no frame: the schema line with the header, then
/// a row a frame, each with its line end.
[[nodiscard]] std::string feature_motion_header(std::span<const std::string> names, double rate_hz);
[[nodiscard]] std::string feature_motion_row(std::size_t frame_number, const FeatureFrame& frame);

}  // namespace mimik::capture
