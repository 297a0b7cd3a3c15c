#include "evaluation/lip_aperture.h"

#include <algorithm>
#include <string_view>

#include "geometry/face_axes.h"
#include "geometry/point_index.h"

namespace mimik::evaluation {

using geometry::Landmarks;
using geometry::Point;
using geometry::Vector;

namespace {

// Landmarks are marked to about 1 mm, so 2 mm off the line between the lips is the marked lip's own skin.
constexpr double into_lip_mm = 2.0;
constexpr double least_share_of_way = 0.5;
constexpr double reach_mm = 3.0;  // skin farther from the place than that is no answer for it

/// From the inner border of the lower lip to that of the upper one.
std::optional<Vector> gap_mm(const Landmarks& landmarks) {
    const auto* upper = landmarks.find("upper_lip_inner");
    const auto* lower = landmarks.find("lower_lip_inner");
    if (!upper || !lower) return std::nullopt;
    return upper->position_mm - lower->position_mm;
}

/// How the skin of one lip moves in its middle.
std::optional<Vector> motion_of_lip(const JudgedFace& face, std::string_view inner_name, std::string_view outer_name) {
    const auto& neutral = face.neutral;
    const auto* inner = neutral.landmarks.find(inner_name);
    const auto* outer = neutral.landmarks.find(outer_name);
    if (!inner || !outer) return std::nullopt;
    const Vector height = outer->position_mm - inner->position_mm;
    // Of a thin lip not beyond its middle.
    const double into_mm = std::min(into_lip_mm, 0.5 * height.norm());
    const Vector outward = height.stableNormalized();
    const Point place = inner->position_mm + into_mm * outward;
    // Where a scan lacks the lip's own skin, that between the lips is nearest and says nothing of either.
    const auto nearest = geometry::nearest_point(neutral.vertices_mm, place, [&](std::size_t v) {
        return neutral.measured[v] != 0 &&
               outward.dot(neutral.vertices_mm[v] - inner->position_mm) >= least_share_of_way * into_mm;
    });
    if (!nearest || (neutral.vertices_mm[*nearest] - place).norm() > reach_mm) return std::nullopt;
    return face.way_mm(static_cast<std::uint32_t>(*nearest));
}

class LipApertureEstimator : public Estimator {
public:
    [[nodiscard]] std::string name() const override { return "lip_aperture"; }
    [[nodiscard]] std::vector<Measure> measure(const JudgedFace& face) const override {
        const auto found = lip_aperture(face);
        if (!found) return {};
        return {{"mouth", "animated", found->animated_mm, "mm"},
                {"mouth", "real", found->real_mm, "mm"},
                {"mouth", "error", found->animated_mm - found->real_mm, "mm"}};
    }
};

}  // namespace

std::optional<LipAperture> lip_aperture(const JudgedFace& face) {
    const auto axes = geometry::head_axes(face.neutral.landmarks);
    const auto neutral = gap_mm(face.neutral.landmarks), real = gap_mm(face.target.expressive_landmarks);
    if (!axes || !neutral || !real) return std::nullopt;
    const auto upper = motion_of_lip(face, "upper_lip_inner", "upper_lip_outer");
    const auto lower = motion_of_lip(face, "lower_lip_inner", "lower_lip_outer");
    if (!upper || !lower) return std::nullopt;
    return LipAperture{axes->up.dot(*neutral + *upper - *lower), axes->up.dot(*real)};
}

std::unique_ptr<const Estimator> lip_aperture_estimator() { return std::make_unique<LipApertureEstimator>(); }

}  // namespace mimik::evaluation
