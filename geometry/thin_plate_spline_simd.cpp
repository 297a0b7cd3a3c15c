#include "geometry/thin_plate_spline_simd.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/thin_plate_spline_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "geometry/simd_doubles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mimik::geometry::simd::HWY_NAMESPACE {
namespace {

constexpr double ln_2 = 0x1.62e42fefa39efp-1;

// Polynomials of the logarithm to base 2: interpolation in Chebyshev nodes, error below 1e-16. The sums that are asked
// for need a small absolute error, not a small relative one near log 1, which is what makes the short forms possible.

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL

/// 1 / c and log2 c for the middles c of the sixteen intervals [1 + i/16, 1 + (i+1)/16).
alignas(64) constexpr double reciprocal_of_middle[16] = {
    0x1.f07c1f07c1f08p-1, 0x1.d41d41d41d41dp-1, 0x1.bacf914c1bad0p-1, 0x1.a41a41a41a41ap-1,
    0x1.8f9c18f9c18fap-1, 0x1.7d05f417d05f4p-1, 0x1.6c16c16c16c17p-1, 0x1.5c9882b931057p-1,
    0x1.4e5e0a72f0539p-1, 0x1.4141414141414p-1, 0x1.3521cfb2b78c1p-1, 0x1.29e4129e4129ep-1,
    0x1.1f7047dc11f70p-1, 0x1.15b1e5f75270dp-1, 0x1.0c9714fbcda3bp-1, 0x1.0410410410410p-1};
alignas(64) constexpr double log2_of_middle[16] = {
    0x1.6bad3758efd81p-5, 0x1.08c588cda79e5p-3, 0x1.acf5e2db4ec91p-3, 0x1.24407ab0e073ap-2,
    0x1.6e221cd9d0cddp-2, 0x1.b47ebf73882a1p-2, 0x1.f7a8568cb06cep-2, 0x1.1bf311e95d00ep-1,
    0x1.3abb3faa02168p-1, 0x1.5848226989d34p-1, 0x1.74b1fd64e0754p-1, 0x1.900e6160002cep-1,
    0x1.aa708f58014d4p-1, 0x1.c3e9ca2e1a055p-1, 0x1.dc899ab3ff56cp-1, 0x1.f45e08bcf0656p-1};

/// Logarithm to base 2 of positive normal numbers. Instructions for exponent, mantissa and a lookup in sixteen entries
/// are what this instruction set has and Highway does not name; no division is left.
HWY_INLINE V log2_of(D d, V x) {
    const V exponent{_mm512_getexp_pd(x.raw)};
    const V mantissa{_mm512_getmant_pd(x.raw, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_zero)};
    const __m512i entry = _mm512_srli_epi64(_mm512_castpd_si512(x.raw), 48);  // the lookup reads the low four bits only
    const V reciprocal{
        _mm512_permutex2var_pd(_mm512_load_pd(reciprocal_of_middle), entry, _mm512_load_pd(reciprocal_of_middle + 8))};
    const V log2_middle{
        _mm512_permutex2var_pd(_mm512_load_pd(log2_of_middle), entry, _mm512_load_pd(log2_of_middle + 8))};
    const V t = hn::MulSub(mantissa, reciprocal, hn::Set(d, 1.0));  // |t| <= 1/33
    V p = hn::Set(d, -0x1.71df85ce2f7f8p-3);
    p = hn::MulAdd(p, t, hn::Set(d, 0x1.a6b1e4e0d254fp-3));
    p = hn::MulAdd(p, t, hn::Set(d, -0x1.ec70895383881p-3));
    p = hn::MulAdd(p, t, hn::Set(d, 0x1.2776b9b451c56p-2));
    p = hn::MulAdd(p, t, hn::Set(d, -0x1.715476533332dp-2));
    p = hn::MulAdd(p, t, hn::Set(d, 0x1.ec709dc428eccp-2));
    p = hn::MulAdd(p, t, hn::Set(d, -0x1.71547652b82f7p-1));
    p = hn::MulAdd(p, t, hn::Set(d, 0x1.71547652b82fap+0));
    return hn::MulAdd(p, t, hn::Add(exponent, log2_middle));
}

#else

/// Logarithm to base 2 of positive normal numbers: 2 artanh((m - 1) / (m + 1)) with m in [sqrt(1/2), sqrt(2)).
HWY_INLINE V log2_of(D d, V x) {
    const hn::RebindToUnsigned<D> du;
    const auto root_half = hn::Set(du, std::uint64_t{0x3fe6a09e667f3bcd});
    const auto shifted =
        hn::Add(hn::BitCast(du, x), hn::Set(du, std::uint64_t{0x3ff0000000000000 - 0x3fe6a09e667f3bcd}));
    // The exponent's bits below those of 2^52 read as 2^52 + exponent.
    const V exponent =
        hn::Sub(hn::BitCast(d, hn::Or(hn::ShiftRight<52>(shifted), hn::Set(du, std::uint64_t{0x4330000000000000}))),
                hn::Set(d, 0x1p52 + 1023));
    const V mantissa =
        hn::BitCast(d, hn::Add(hn::And(shifted, hn::Set(du, std::uint64_t{0x000fffffffffffff})), root_half));
    const V one = hn::Set(d, 1.0);
    const V s = hn::Div(hn::Sub(mantissa, one), hn::Add(mantissa, one));  // |s| <= 0.1716
    const V z = hn::Mul(s, s);
    V p = hn::Set(d, 0x1.f17dfd13ae0efp-3);
    p = hn::MulAdd(p, z, hn::Set(d, 0x1.0bb80a92c80ccp-2));
    p = hn::MulAdd(p, z, hn::Set(d, 0x1.484fa9965bc9cp-2));
    p = hn::MulAdd(p, z, hn::Set(d, 0x1.a61756810b0f8p-2));
    p = hn::MulAdd(p, z, hn::Set(d, 0x1.2776c516a083cp-1));
    p = hn::MulAdd(p, z, hn::Set(d, 0x1.ec709dc39ca40p-1));
    p = hn::MulAdd(p, z, hn::Set(d, 0x1.71547652b82ffp+1));
    return hn::MulAdd(p, s, exponent);
}

#endif

/// U in units of `kernel_unit`: -r, or r^2 log2 r^2.
template <SplineKernel kernel>
constexpr double kernel_unit = kernel == SplineKernel::r ? 1.0 : ln_2;

template <SplineKernel kernel>
HWY_INLINE V kernel_of(D d, V squared_distance) {
    if constexpr (kernel == SplineKernel::r) {
        return hn::Neg(hn::Sqrt(squared_distance));
    } else {
        // At r = 0 the logarithm sees the smallest normal number, and the product is 0 all the same.
        const V positive = hn::Max(squared_distance, hn::Set(d, std::numeric_limits<double>::min()));
        return hn::Mul(squared_distance, log2_of(d, positive));
    }
}

HWY_INLINE V squared_distance(V x, V y, V z, V cx, V cy, V cz) {
    const V dx = hn::Sub(x, cx), dy = hn::Sub(y, cy), dz = hn::Sub(z, cz);
    return hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
}

constexpr std::size_t vectors_per_block = 2;  // shares the loads of centres and weights

template <SplineKernel kernel>
HWY_INLINE void evaluate_block(D d, const SplineTerms& spline, const double* points, double* targets) {
    const std::size_t stride = 3 * hn::Lanes(d);
    V x0, y0, z0, x1, y1, z1;
    hn::LoadInterleaved3(d, points, x0, y0, z0);
    hn::LoadInterleaved3(d, points + stride, x1, y1, z1);
    V sx0 = hn::Zero(d), sy0 = sx0, sz0 = sx0, sx1 = sx0, sy1 = sx0, sz1 = sx0;
    for (std::size_t j = 0; j < 3 * spline.count; j += 3) {
        const V cx = hn::Set(d, spline.centres[j]), cy = hn::Set(d, spline.centres[j + 1]),
                cz = hn::Set(d, spline.centres[j + 2]);
        const V u0 = kernel_of<kernel>(d, squared_distance(x0, y0, z0, cx, cy, cz));
        const V u1 = kernel_of<kernel>(d, squared_distance(x1, y1, z1, cx, cy, cz));
        const V wx = hn::Set(d, spline.weights[j]), wy = hn::Set(d, spline.weights[j + 1]),
                wz = hn::Set(d, spline.weights[j + 2]);
        sx0 = hn::MulAdd(u0, wx, sx0);
        sy0 = hn::MulAdd(u0, wy, sy0);
        sz0 = hn::MulAdd(u0, wz, sz0);
        sx1 = hn::MulAdd(u1, wx, sx1);
        sy1 = hn::MulAdd(u1, wy, sy1);
        sz1 = hn::MulAdd(u1, wz, sz1);
    }
    const auto with_affine = [&](const double* row, V x, V y, V z, V sum) HWY_ATTR {
        V value = hn::MulAdd(x, hn::Set(d, row[0]), hn::Set(d, row[3]));
        value = hn::MulAdd(y, hn::Set(d, row[1]), value);
        value = hn::MulAdd(z, hn::Set(d, row[2]), value);
        return hn::MulAdd(sum, hn::Set(d, kernel_unit<kernel>), value);
    };
    const double* a = spline.affine;
    hn::StoreInterleaved3(with_affine(a, x0, y0, z0, sx0), with_affine(a + 4, x0, y0, z0, sy0),
                          with_affine(a + 8, x0, y0, z0, sz0), d, targets);
    hn::StoreInterleaved3(with_affine(a, x1, y1, z1, sx1), with_affine(a + 4, x1, y1, z1, sy1),
                          with_affine(a + 8, x1, y1, z1, sz1), d, targets + stride);
}

template <SplineKernel kernel>
void evaluate_all(const SplineTerms& spline, const double* points, double* targets, std::size_t count) {
    const D d;
    const std::size_t block = vectors_per_block * hn::Lanes(d);
    std::size_t i = 0;
    for (; i + block <= count; i += block) evaluate_block<kernel>(d, spline, points + 3 * i, targets + 3 * i);
    if (i == count) return;
    // The rest goes through the same code, filled up with zeros.
    double padded[3 * vectors_per_block * HWY_MAX_BYTES / sizeof(double)] = {};
    std::copy(points + 3 * i, points + 3 * count, padded);
    evaluate_block<kernel>(d, spline, padded, padded);
    std::copy(padded, padded + 3 * (count - i), targets + 3 * i);
}

void evaluate_here(const SplineTerms& spline, const double* points, double* targets, std::size_t count) {
    if (spline.kernel == SplineKernel::r)
        evaluate_all<SplineKernel::r>(spline, points, targets, count);
    else
        evaluate_all<SplineKernel::r2_log_r2>(spline, points, targets, count);
}

template <SplineKernel kernel>
void values_of(const double* centre, const double* points, double* values, std::size_t count) {
    const D d;
    const V cx = hn::Set(d, centre[0]), cy = hn::Set(d, centre[1]), cz = hn::Set(d, centre[2]);
    const auto one_vector = [&](const double* from, double* to) HWY_ATTR {
        V x, y, z;
        hn::LoadInterleaved3(d, from, x, y, z);
        const V u = kernel_of<kernel>(d, squared_distance(x, y, z, cx, cy, cz));
        hn::StoreU(hn::Mul(u, hn::Set(d, kernel_unit<kernel>)), d, to);
    };
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) one_vector(points + 3 * i, values + i);
    if (i == count) return;
    double padded[3 * HWY_MAX_BYTES / sizeof(double)] = {};
    double padded_values[HWY_MAX_BYTES / sizeof(double)];
    std::copy(points + 3 * i, points + 3 * count, padded);
    one_vector(padded, padded_values);
    std::copy(padded_values, padded_values + (count - i), values + i);
}

void values_here(SplineKernel kernel, const double* centre, const double* points, double* values, std::size_t count) {
    if (kernel == SplineKernel::r)
        values_of<SplineKernel::r>(centre, points, values, count);
    else
        values_of<SplineKernel::r2_log_r2>(centre, points, values, count);
}

}  // namespace
}  // namespace mimik::geometry::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mimik::geometry::simd {
HWY_EXPORT(evaluate_here);
HWY_EXPORT(values_here);

void evaluate_spline(const SplineTerms& spline, const double* points, double* targets, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(evaluate_here)(spline, points, targets, count);
}

void kernel_values(SplineKernel kernel, const double* centre, const double* points, double* values, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(values_here)(kernel, centre, points, values, count);
}

}  // namespace mimik::geometry::simd
#endif
