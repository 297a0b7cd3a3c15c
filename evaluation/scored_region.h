#pragma once

#include <span>
#include <string>
#include <vector>

#include "evaluation/estimated_target.h"
#include "facs/facs_catalogue.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face.h"

namespace mimik::evaluation {

/// "zone" (the expression's active zone), "face", "upper" and "lower" (the thesis's halves), "nose", "mouth", "eyes",
/// "cheeks", "forehead" (with the brows), "chin", "wrinkles" (within 8 mm of the catalogue's wrinkle points of the
/// expression), and every label of modeling::label_regions, such as "brow_left".
[[nodiscard]] std::vector<std::string> known_regions();
/// @throws InputError listing them.
void check_region(const std::string& name);

/// The regions on a neutral face's own grid. Labels are drawn on the average face and carried to the face as zones are:
/// by the landmark spline and the nearest vertex; beyond 5 mm off the average face's rim there is no label.
/// @param zone  per vertex of the face: carry_zone()
/// @throws InputError for an unknown region, or a landmark that a border needs.
[[nodiscard]] RegionMasks regions_on(const preprocessing::Face& neutral, const preprocessing::AverageFace& average,
                                     const facs::FacsCatalogue& catalogue, const facs::Expression& expression,
                                     const geometry::VertexMask& zone, std::span<const std::string> names);

}  // namespace mimik::evaluation
