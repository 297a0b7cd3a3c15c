#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/types.h"

namespace mimik::geometry {

/// One named point. `name` is ours and always on the subject's own side; `original_label` is what the file said.
struct Landmark {
    std::string name;
    Point position_mm = Point::Zero();
    std::string original_label;
};

/// Names are unique, positions finite; the order of the file is kept.
class Landmarks {
public:
    Landmarks() = default;
    explicit Landmarks(std::vector<Landmark> marks);  ///< throws InputError naming the bad mark

    [[nodiscard]] const Landmark* find(std::string_view name) const;  ///< nullptr: absent, which is an ordinary answer
    [[nodiscard]] const Landmark& at(std::string_view name) const;    ///< throws InputError listing the names there are
    [[nodiscard]] const Point& position_mm(std::string_view name) const { return at(name).position_mm; }
    [[nodiscard]] std::span<const Landmark> all() const { return marks_; }
    [[nodiscard]] std::size_t size() const { return marks_.size(); }
    [[nodiscard]] bool empty() const { return marks_.empty(); }

private:
    std::vector<Landmark> marks_;
};

struct LandmarkPair {
    std::string name;
    Point source_mm, target_mm;
};

/// Pairs by name (order of `source`), and what found no partner.
struct LandmarkPairing {
    std::vector<LandmarkPair> pairs;
    std::vector<std::string> only_in_source, only_in_target;
};

[[nodiscard]] LandmarkPairing pair_by_name(const Landmarks& source, const Landmarks& target);

/// Every position through `target_from_source`; names and labels kept.
[[nodiscard]] Landmarks transformed(const Landmarks& landmarks, const Transform& target_from_source);

/// The 22 regular Bosphorus landmarks under our names (subject's own side), in the order of the Bosphorus list when the
/// image-left label is the subject's right:
///   brow_outer_right brow_middle_right brow_inner_right brow_inner_left brow_middle_left brow_outer_left
///   eye_outer_right eye_inner_right eye_inner_left eye_outer_left nose_saddle_right nose_saddle_left
///   nose_wing_right nose_tip nose_wing_left mouth_corner_right upper_lip_outer mouth_corner_left
///   upper_lip_inner lower_lip_inner lower_lip_outer chin
/// Optional ones: ear_lobe_left/right, temple_left/right.
[[nodiscard]] std::span<const std::string_view> standard_landmark_names();

/// "mouth_corner_left" <-> "mouth_corner_right"; a name without a side is its own mirror.
[[nodiscard]] std::string mirrored_name(std::string_view name);

}  // namespace mimik::geometry
