#include "facs/placement.h"

#include <algorithm>

#include "geometry/face_axes.h"

namespace mimik::facs {
namespace {

/// The landmark that a name of a placement means on one side: of the midline, or with both sides, as it is.
std::string landmark_on(const std::string& name, Side side) {
    const auto& known = geometry::standard_landmark_names();
    return std::find(known.begin(), known.end(), name) != known.end() ? name : name + side_suffix(side);
}

}  // namespace

const char* side_suffix(Side side) { return side == Side::right ? "_right" : "_left"; }

bool on_midline(const Placement& placement) {
    return placement.lateral == 0.0 && std::all_of(placement.at.begin(), placement.at.end(), [](const auto& term) {
               return landmark_on(term.first, Side::left) == term.first;
           });
}

std::vector<std::string> missing_marks(const Placement& placement, const geometry::Landmarks& landmarks, Side side) {
    std::vector<std::string> missing;
    for (const auto& [name, weight] : placement.at)
        if (auto full = landmark_on(name, side); !landmarks.find(full)) missing.push_back(std::move(full));
    return missing;
}

geometry::Point place(const Placement& placement, const geometry::Landmarks& landmarks, Side side) {
    geometry::Point position = geometry::Point::Zero();
    for (const auto& [name, weight] : placement.at) position += weight * landmarks.position_mm(landmark_on(name, side));
    const double unit = geometry::outer_eye_distance_mm(landmarks);
    const double away = side == Side::right ? -1.0 : 1.0;
    return position + geometry::Point(away * placement.lateral * unit, placement.up * unit, 0.0);
}

}  // namespace mimik::facs
