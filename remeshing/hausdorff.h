#pragma once

#include "geometry/mesh.h"

namespace mimik::remeshing {

/// How far two surfaces lie apart at most, each to within `error_bound_mm`.
struct Hausdorff {
    double first_to_second_mm = 0.0;  ///< the largest distance from a point of the first to the second
    double second_to_first_mm = 0.0;
    double error_bound_mm = 0.0;
    [[nodiscard]] double mm() const {
        return first_to_second_mm > second_to_first_mm ? first_to_second_mm : second_to_first_mm;
    }
};

/// Over all points of the surfaces and not only their vertices (Kang, Kyung, Yoon and Kim 2018, as CGAL has it: boxes
/// whose bounds close in). Faces without area are left out.
/// @throws InputError if a mesh has no face of any area, or the bound is not above 0.
[[nodiscard]] Hausdorff hausdorff(const geometry::Mesh& first, const geometry::Mesh& second,
                                  double error_bound_mm = 0.01);

}  // namespace mimik::remeshing
