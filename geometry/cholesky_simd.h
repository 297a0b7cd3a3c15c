#pragma once

#include <cstddef>

/// Compiled once per instruction set and chosen at run time; plain arrays only (see thin_plate_spline_simd.h).
namespace mimik::geometry::simd {

/// The array of factor_cholesky must have this many rows for `rows` used ones: whole vectors, and no stride that makes
/// all columns fall on the same lines of the cache.
[[nodiscard]] std::size_t cholesky_stride(std::size_t rows);

/// In place L with L L^T = A. `a` is column after column, `stride` apart, of which the lower triangle of the first
/// `columns` rows is A (the upper one is scratch). The rows from `columns` to `rows` are right-hand sides B^T, which
/// become (L^-1 B)^T on the way. Rows from `rows` to `stride` must be zero.
/// @return false, with the array half done, if a pivot is not above `least_pivot`: A is not positive definite.
/// Cost columns^3 / 3, blocked; the same bits on every run on one machine.
[[nodiscard]] bool factor_cholesky(double* a, std::size_t rows, std::size_t columns, std::size_t stride,
                                   double least_pivot);

}  // namespace mimik::geometry::simd
