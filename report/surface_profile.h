#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::report {

/// A cut through a face along a straight line of the picture: where it runs in x and y, of any depth.
struct CutLine {
    std::array<double, 2> from_mm{}, to_mm{};
    int samples = 201;
};

/// One point of a cut: how far along the line, and the depth z of the surface that lies in front there, mm; NaN where
/// the line meets no surface.
using ProfilePoint = std::array<double, 2>;

/// The profile of a surface that faces +z. @throws InputError for fewer than 2 samples or a line without length.
[[nodiscard]] std::vector<ProfilePoint> surface_profile(const geometry::Mesh& mesh, const CutLine& line);

}  // namespace mimik::report
