// What the vector kernels of doubles are written in, once per instruction set: included after highway.h, and again for
// each target, so its guard turns over with Highway's own.
#if defined(MIMIK_SIMD_DOUBLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MIMIK_SIMD_DOUBLES_INL
#undef MIMIK_SIMD_DOUBLES_INL
#else
#define MIMIK_SIMD_DOUBLES_INL
#endif

HWY_BEFORE_NAMESPACE();
namespace mimik::geometry::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

}  // namespace mimik::geometry::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
