#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/image.h"
#include "synthesis/scanner.h"
#include "synthesis/subject.h"

namespace mimik::synthesis {

/// The scanner's photograph of a face: an orthographic view along -z with skin, lips, brows, hair and eyes in the
/// person's own colours, lit from above the camera. The camera is that of scan.texture_coordinates.
/// @param vertices_mm the surface in the head frame, as it was scanned
[[nodiscard]] geometry::Image photograph(const FaceModel& model, const Subject& subject,
                                         const std::vector<geometry::Point>& vertices_mm, const FaceWindow& window,
                                         const SyntheticScan& scan, std::uint64_t seed,
                                         const ScannerOptions& options = {});

}  // namespace mimik::synthesis
