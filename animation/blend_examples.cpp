#include "animation/blend_examples.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"

namespace mimik::animation {

static_assert(sizeof(geometry::Point) == 3 * sizeof(double), "points are taken for coordinates one after another");

ExampleBlender::ExampleBlender(std::vector<geometry::Point> neutral_mm,
                               std::span<const std::vector<geometry::Vector>> displacements_mm)
    : neutral_mm_(std::move(neutral_mm)) {
    for (std::size_t i = 0; i < displacements_mm.size(); ++i) {
        const auto& moved = displacements_mm[i];
        if (moved.size() != neutral_mm_.size())
            throw InputError(fmt::format("example {} moves {} of {} vertices", i, moved.size(), neutral_mm_.size()));
        const auto moves = [](const geometry::Vector& d) { return !d.isZero(0.0); };
        const auto first = std::find_if(moved.begin(), moved.end(), moves);
        auto last = moved.end();
        while (last != first && !moves(*(last - 1))) --last;
        Range range{3 * static_cast<std::size_t>(first - moved.begin()),
                    3 * static_cast<std::size_t>(last - moved.begin()), displacements_.size()};
        for (auto at = first; at != last; ++at) displacements_.insert(displacements_.end(), at->begin(), at->end());
        ranges_.push_back(range);
    }
}

void ExampleBlender::blend(std::span<const double> weights, std::span<geometry::Point> vertices_mm) const {
    if (weights.size() != ranges_.size() || vertices_mm.size() != neutral_mm_.size())
        throw InputError(fmt::format("{} weights for {} examples, and {} vertices for {}", weights.size(),
                                     ranges_.size(), vertices_mm.size(), neutral_mm_.size()));
    // A block of the answer stays in the nearest cache while all examples are added to it.
    constexpr std::size_t block = 1536;
    const std::size_t coordinates = 3 * neutral_mm_.size();
    const double* neutral = neutral_mm_.empty() ? nullptr : neutral_mm_.front().data();
    double* out = vertices_mm.empty() ? nullptr : vertices_mm.front().data();
    for (std::size_t begin = 0; begin < coordinates; begin += block) {
        const std::size_t end = std::min(begin + block, coordinates);
        std::copy(neutral + begin, neutral + end, out + begin);
        for (std::size_t i = 0; i < ranges_.size(); ++i) {
            const double weight = weights[i];
            const auto& range = ranges_[i];
            const std::size_t from = std::max(begin, range.first), to = std::min(end, range.last);
            if (weight == 0 || from >= to) continue;
            const double* moved = displacements_.data() + range.begins + (from - range.first);
            for (std::size_t c = from; c < to; ++c) out[c] += weight * moved[c - from];
        }
    }
}

}  // namespace mimik::animation
