#include "facs/face_regions.h"

#include <algorithm>

namespace mimik::facs {

using geometry::Point;

RegionBorder::RegionBorder(const geometry::Landmarks& landmarks) {
    const Point &left = landmarks.position_mm("eye_outer_left"), &right = landmarks.position_mm("eye_outer_right");
    const Point inner = 0.5 * (landmarks.position_mm("eye_inner_left") + landmarks.position_mm("eye_inner_right"));
    const Point eyes = 0.5 * (0.5 * (left + right) + inner);
    const geometry::Vector across = (left - right).normalized();
    up_ = eyes - landmarks.position_mm("chin");
    up_ = (up_ - across * across.dot(up_)).normalized();
    border_ = up_.dot(eyes) + 0.25 * up_.dot(landmarks.position_mm("nose_tip") - eyes);
}

std::vector<double> region_weights(std::span<const Point> vertices_mm, const geometry::VertexMask& present,
                                   const geometry::Landmarks& landmarks, bool lower_face, double border_mm) {
    const RegionBorder border(landmarks);
    std::vector<double> weights(vertices_mm.size(), 0.0);
    for (std::size_t v = 0; v < vertices_mm.size(); ++v) {
        if (!present[v]) continue;
        const double above = border.above_mm(vertices_mm[v]) * (lower_face ? -1.0 : 1.0);
        if (border_mm <= 0) {
            weights[v] = lower_face ? above > 0 : above >= 0;
            continue;
        }
        const double t = std::clamp(0.5 + above / border_mm, 0.0, 1.0);
        weights[v] = t * t * (3 - 2 * t);
    }
    return weights;
}

}  // namespace mimik::facs
