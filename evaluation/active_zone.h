#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/types.h"
#include "modeling/facs_catalogue.h"
#include "preprocessing/average_face.h"
#include "preprocessing/face.h"
#include "synthesis/truth.h"

namespace mimik::evaluation {

/// Where an expression moves the skin, on the average face: the part of a face on which methods are compared.
struct ActiveZone {
    std::string expression;
    std::vector<char> active;             ///< per vertex of the average face's grid
    std::vector<double> displacement_mm;  ///< mean over subjects, where it is known from a truth; else empty
};

/// One subject of a synthetic database: its preprocessed neutral and the truth of neutral and expression.
struct TrueSubject {
    const preprocessing::Face* neutral = nullptr;
    const synthesis::TrueScan* true_neutral = nullptr;
    const synthesis::TrueScan* true_expression = nullptr;  ///< displacement_mm from the neutral scan
};

/// Active where the length of the mean true displacement over subjects exceeds `share` of its maximum on the average
/// face.
[[nodiscard]] ActiveZone active_zone_from_truth(const std::string& expression,
                                                const preprocessing::AverageFace& average,
                                                std::span<const TrueSubject> subjects, double share = 0.2);

/// The same region as the catalogue draws it, for databases without a truth.
[[nodiscard]] ActiveZone active_zone_from_catalogue(const std::string& expression,
                                                    const preprocessing::AverageFace& average,
                                                    const modeling::FacsCatalogue& catalogue);

/// The zone on a face's own grid: every vertex goes to the average face by the landmark spline and takes what the
/// nearest average vertex has. Vertices outside the face, or farther than 5 mm off the average face's rim, are not
/// active.
[[nodiscard]] std::vector<char> carry_zone(const ActiveZone& zone, const preprocessing::AverageFace& average,
                                           const preprocessing::Face& face);

/// Landmark spline (kernel r) from the average face to a face, both in their own frames.
[[nodiscard]] std::vector<geometry::Point> average_vertices_on(const preprocessing::AverageFace& average,
                                                               const preprocessing::Face& face);

}  // namespace mimik::evaluation
