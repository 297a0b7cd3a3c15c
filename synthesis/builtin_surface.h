#pragma once

#include <vector>

#include "synthesis/builtin_measurements.h"
#include "synthesis/builtin_sheet.h"

namespace mimik::synthesis {

/// The points of the midline, solved from the measured distances (triangles nasion - pronasale - subnasale and so on).
struct Profile {
    Eigen::Vector2d pronasale, subnasale, upper_lip, stomion, lower_lip, sulcus, pogonion, gnathion;  ///< (y, z), mm
};
[[nodiscard]] Profile solve_profile(const FaceNumbers& face);

/// The neutral skin of one person; the nasion is the origin.
[[nodiscard]] std::vector<geometry::Point> build_neutral_mm(const Sheet& sheet, const FaceNumbers& face);

}  // namespace mimik::synthesis
