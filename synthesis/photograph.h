#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/image.h"
#include "synthesis/scanner.h"
#include "synthesis/subject.h"

namespace mimik::synthesis {

/// A person's own colours, 0..255, the same on every photograph.
struct Complexion {
    using Colour = Eigen::Vector3d;
    std::vector<Colour> colours;    ///< per vertex: skin with its blotches, lips, nostrils
    std::vector<double> hairiness;  ///< per vertex: 0 bare to 1 covered
    std::vector<double> eyeball;    ///< per vertex: 1 on the ball of the eye, else 0
    Colour hair = Colour::Zero(), iris = Colour::Zero();
};
[[nodiscard]] Complexion draw_complexion(const FaceModel& model, const Subject& subject, const FaceWindow& window,
                                         std::uint64_t seed);

/// The scanner's photograph of a face: an orthographic view along -z, lit from above the camera. The camera is that of
/// scan.texture_coordinates.
/// @param vertices_mm the surface in the head frame, as it was scanned
[[nodiscard]] io::Image photograph(const FaceModel& model, const Complexion& complexion,
                                   const std::vector<geometry::Point>& vertices_mm, const SyntheticScan& scan,
                                   const ScannerOptions& options = {});

}  // namespace mimik::synthesis
