#pragma once

#include <cstddef>

#include "geometry/spline_kernel.h"

/// The inner loops of ThinPlateSpline, compiled once per instruction set and chosen at run time. Plain arrays only:
/// Eigen must not be compiled with other instruction sets than the rest of the program.
namespace mimik::geometry::simd {

/// Points, centres and weights are x y z x y z ...; `affine` is 3 x 4, row after row.
struct SplineTerms {
    SplineKernel kernel = SplineKernel::r;
    const double* centres = nullptr;
    const double* weights = nullptr;
    std::size_t count = 0;
    const double* affine = nullptr;
};

/// targets[i] = affine * points[i] + sum_j weights[j] U(|points[i] - centres[j]|). Each point's result depends on that
/// point alone, to the last bit. `targets` may be `points`.
void evaluate_spline(const SplineTerms& spline, const double* points, double* targets, std::size_t count);

/// values[i] = U(|points[i] - centre|).
void kernel_values(SplineKernel kernel, const double* centre, const double* points, double* values, std::size_t count);

}  // namespace mimik::geometry::simd
