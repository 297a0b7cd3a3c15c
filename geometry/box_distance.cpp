#include "geometry/box_distance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/box_distance.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mimik::geometry::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

std::uint32_t box_distances_here(const BoxNode& node, const float* query_low, const float* query_high, float limit,
                                 float* squared) {
    const hn::CappedTag<float, BoxNode::width> lanes;
    const auto zero = hn::Zero(lanes);
    std::uint32_t within = 0;
    for (std::size_t k = 0; k < BoxNode::width; k += hn::Lanes(lanes)) {
        auto sum = zero;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto before = hn::Sub(hn::Load(lanes, &node.low[axis][k]), hn::Set(lanes, query_high[axis]));
            const auto after = hn::Sub(hn::Set(lanes, query_low[axis]), hn::Load(lanes, &node.high[axis][k]));
            const auto gap = hn::Max(hn::Max(before, after), zero);
            sum = hn::Add(sum, hn::Mul(gap, gap));
        }
        // Six roundings, each below 6e-8 of the sum.
        sum = hn::Mul(sum, hn::Set(lanes, 0.999999F));
        hn::Store(sum, lanes, squared + k);
        std::uint8_t bits[8] = {};  // StoreMaskBits may write eight bytes
        hn::StoreMaskBits(lanes, hn::Le(sum, hn::Set(lanes, limit)), bits);
        within |= static_cast<std::uint32_t>(bits[0]) << k;
    }
    return within;
}

}  // namespace mimik::geometry::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mimik::geometry {
HWY_EXPORT(box_distances_here);

BoxDistances box_distances() {
    // Without this the first call would go through a detour that finds out what the machine has.
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return &HWY_DYNAMIC_DISPATCH(box_distances_here);
}
}  // namespace mimik::geometry
#endif
