#pragma once

#include <span>
#include <vector>

#include "geometry/types.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face_template.h"

namespace mimik::evaluation {

/// Carries motion of the template (KeptRegistrations::motion) to the grid of the average face from which it was made:
/// every vertex takes what the template's nearest point has.
class MotionOnAverage {
public:
    MotionOnAverage(const preprocessing::AverageFace& average, const preprocessing::FaceTemplate& face_template);
    /// One vector per vertex of the average face's grid, its frame; zero outside the face, and where the template ends
    /// 5 mm or more away. @param motion_mm  per vertex of the template, average frame
    [[nodiscard]] std::vector<geometry::Vector> of(std::span<const geometry::Vector> motion_mm) const;

private:
    struct Place {
        std::size_t vertex = 0;  // of the grid
        geometry::Triangle corners = {0, 0, 0};
        Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    };
    std::size_t size_ = 0;
    std::vector<Place> places_;
};

}  // namespace mimik::evaluation
