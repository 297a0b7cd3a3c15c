#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "geometry/landmarks.h"
#include "geometry/mesh.h"
#include "geometry/thin_plate_spline.h"

namespace mimik::io {

/// How a warp moves its input: coordinates are taken as they are, in whatever unit, so the limits of
/// ThinPlateSplineOptions are given here as fractions of the size of the landmark cloud (root mean square radius).
struct WarpOptions {
    geometry::SplineKernel kernel = geometry::SplineKernel::r;
    double smoothing = 0.0;              ///< X in K + X I, in the unit of K as the files give it
    double min_separation_ratio = 1e-9;  ///< closer landmarks are taken for one point marked twice
    double min_thickness_ratio = 1e-5;   ///< flatter clouds say nothing about what lies off their plane
    /// Asked before the image that a mesh names is copied; throws to refuse it.
    std::function<void(const std::filesystem::path&)> check_texture = {};
    void check() const;
};

/// The spline that takes `from` to `to`, paired by name.
/// @throws InputError listing every name that has no partner; what ThinPlateSpline::fit throws.
[[nodiscard]] geometry::ThinPlateSpline fit_landmark_spline(const geometry::Landmarks& from,
                                                            const geometry::Landmarks& to,
                                                            const WarpOptions& options = {});

/// Every vertex through the spline; faces, texture coordinates, colours and attributes kept.
[[nodiscard]] geometry::Mesh warped(geometry::Mesh mesh, const geometry::ThinPlateSpline& spline);

struct WarpReport {
    std::size_t landmarks = 0;
    std::size_t points = 0;                ///< moved, in the input file
    double largest_landmark_residual = 0;  ///< |spline(from) - to|: rounding only, unless smoothing > 0
    double bending_energy = 0;
    double largest_displacement = 0;  ///< of the points of the input
};

/// Warps a file: points as CSV (name,x,y,z) or a mesh (PLY, OBJ, STL, PCD, VTP), by extension, to a file of the same or
/// another of these formats (not PCD). CSV keeps the names; points of a mesh get their number, from 0, as name. The
/// texture image of an output face.ply or face.obj is copied beside it as face_texture.<ext>, the image's extension.
/// @param from, to  landmark files in any form that read_landmarks knows, their coordinates taken as written.
/// @throws InputError; NumericalError also where the place of a point is not finite.
WarpReport warp_file(const std::filesystem::path& from, const std::filesystem::path& to,
                     const std::filesystem::path& input, const std::filesystem::path& output,
                     const WarpOptions& options = {});

}  // namespace mimik::io
