#include "geometry/cholesky_simd.h"

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/cholesky_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "geometry/simd_doubles-inl.h"

#ifndef MIMIK_CHOLESKY_SHAPE
#define MIMIK_CHOLESKY_SHAPE
namespace mimik::geometry::simd {
constexpr std::size_t tile_columns = 4;                  // 2 x 4 sums fill half of 16 registers
constexpr std::size_t block_columns = 6 * tile_columns;  // a panel of so many columns is finished at a time
}  // namespace mimik::geometry::simd
#endif

HWY_BEFORE_NAMESPACE();
namespace mimik::geometry::simd::HWY_NAMESPACE {
namespace {

/// Two vectors of rows by tile_columns columns: c -= left * right^T, `right` packed tile_columns numbers per term.
HWY_INLINE void subtract_products(D d, double* c, std::size_t columns, const double* left, const double* right,
                                  std::size_t terms, std::size_t stride) {
    const std::size_t lanes = hn::Lanes(d);
    V s00 = hn::Zero(d), s01 = s00, s02 = s00, s03 = s00, s10 = s00, s11 = s00, s12 = s00, s13 = s00;
    for (std::size_t k = 0; k < terms; ++k) {
        const V l0 = hn::LoadU(d, left + k * stride), l1 = hn::LoadU(d, left + k * stride + lanes);
        const double* r = right + k * tile_columns;
        const V r0 = hn::Set(d, r[0]), r1 = hn::Set(d, r[1]), r2 = hn::Set(d, r[2]), r3 = hn::Set(d, r[3]);
        s00 = hn::MulAdd(l0, r0, s00);
        s10 = hn::MulAdd(l1, r0, s10);
        s01 = hn::MulAdd(l0, r1, s01);
        s11 = hn::MulAdd(l1, r1, s11);
        s02 = hn::MulAdd(l0, r2, s02);
        s12 = hn::MulAdd(l1, r2, s12);
        s03 = hn::MulAdd(l0, r3, s03);
        s13 = hn::MulAdd(l1, r3, s13);
    }
    const auto subtract = [&](std::size_t column, V s0, V s1) HWY_ATTR {
        if (column >= columns) return;
        double* at = c + column * stride;
        hn::StoreU(hn::Sub(hn::LoadU(d, at), s0), d, at);
        hn::StoreU(hn::Sub(hn::LoadU(d, at + lanes), s1), d, at + lanes);
    };
    subtract(0, s00, s10);
    subtract(1, s01, s11);
    subtract(2, s02, s12);
    subtract(3, s03, s13);
}

/// Columns [first, first + width) after all columns before `first` have been subtracted; rows from `first` down.
HWY_INLINE bool factor_panel(D d, double* a, std::size_t first, std::size_t width, std::size_t padded_rows,
                             std::size_t stride, double least_pivot) {
    const std::size_t lanes = hn::Lanes(d);
    const std::size_t last = padded_rows;
    double* panel = a + first * stride;
    for (std::size_t j = 0; j < width; ++j) {
        const double* row = panel + first + j;  // L(first + j, first + k) is row[k * stride]
        double pivot = row[j * stride];
        for (std::size_t k = 0; k < j; ++k) pivot -= row[k * stride] * row[k * stride];
        if (!(pivot > least_pivot)) return false;
        const double root = std::sqrt(pivot);
        const V inverse = hn::Set(d, 1 / root);
        // Rows above j within the panel are computed too and never read: they belong to the upper triangle.
        for (std::size_t i = first; i < last; i += 2 * lanes) {
            V s0 = hn::LoadU(d, panel + j * stride + i), s1 = hn::LoadU(d, panel + j * stride + i + lanes);
            for (std::size_t k = 0; k < j; ++k) {
                const V factor = hn::Set(d, row[k * stride]);
                s0 = hn::NegMulAdd(hn::LoadU(d, panel + k * stride + i), factor, s0);
                s1 = hn::NegMulAdd(hn::LoadU(d, panel + k * stride + i + lanes), factor, s1);
            }
            hn::StoreU(hn::Mul(s0, inverse), d, panel + j * stride + i);
            hn::StoreU(hn::Mul(s1, inverse), d, panel + j * stride + i + lanes);
        }
        panel[j * stride + first + j] = root;
    }
    return true;
}

bool factor_here(double* a, std::size_t rows, std::size_t columns, std::size_t stride, double least_pivot) {
    const D d;
    const std::size_t step = 2 * hn::Lanes(d);
    std::vector<double> packed(columns * block_columns);
    for (std::size_t first = 0; first < columns; first += block_columns) {
        const std::size_t width = std::min(block_columns, columns - first);
        // Row tiles start at `first`; the last one may reach beyond `rows`, into the zeros.
        const std::size_t end = first + (rows - first + step - 1) / step * step;
        if (first > 0) {
            for (std::size_t tile = 0; tile < width; tile += tile_columns)
                for (std::size_t k = 0; k < first; ++k)
                    for (std::size_t c = 0; c < tile_columns; ++c)
                        packed[tile * first + k * tile_columns + c] =
                            tile + c < width ? a[k * stride + first + tile + c] : 0.0;
            for (std::size_t i = first; i < end; i += step)
                for (std::size_t tile = 0; tile < width; tile += tile_columns)
                    subtract_products(d, a + (first + tile) * stride + i, width - tile, a + i,
                                      packed.data() + tile * first, first, stride);
        }
        if (!factor_panel(d, a, first, width, end, stride, least_pivot)) return false;
    }
    return true;
}

}  // namespace
}  // namespace mimik::geometry::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mimik::geometry::simd {
HWY_EXPORT(factor_here);

std::size_t cholesky_stride(std::size_t rows) {
    constexpr std::size_t line = 8, two_vectors = 16;                          // of 512 bits, the widest there is
    const std::size_t stride = (rows + two_vectors + line - 1) / line * line;  // the last row tile may start at any row
    return stride % 64 == 0 ? stride + line : stride;
}

bool factor_cholesky(double* a, std::size_t rows, std::size_t columns, std::size_t stride, double least_pivot) {
    return HWY_DYNAMIC_DISPATCH(factor_here)(a, rows, columns, stride, least_pivot);
}

}  // namespace mimik::geometry::simd
#endif
