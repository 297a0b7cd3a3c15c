#pragma once

#include <string>
#include <vector>

#include "preprocessing/average_face.h"
#include "preprocessing/face.h"

namespace mimik::preprocessing {

/// A vertex of the average face's grid.
struct NearestOnAverage {
    std::size_t vertex = 0;
    double distance_mm = 0.0;  ///< infinite for a vertex that is outside its face
};

/// What is to be said of landmarks that only one of the two has: every spline between them goes without. Empty: all
/// have a partner.
[[nodiscard]] std::string without_partner(const Face& face, const AverageFace& average);

/// For each grid vertex of `face` the nearest inside vertex of the average face, after the landmark spline has carried
/// the face there: how what is known on the average face (labels, zones) comes to a face.
[[nodiscard]] std::vector<NearestOnAverage> nearest_on_average(const Face& face, const AverageFace& average);

}  // namespace mimik::preprocessing
