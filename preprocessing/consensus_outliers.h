#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/landmarks.h"

namespace mimik::preprocessing {

struct OutlierOptions {
    double times_median = 4.0;  ///< people differ by up to twice the median; a lost decimal point by ten times and more
    double least = 0.2;         ///< outer-eye distances (17 mm on an adult): no less is far off, however alike the rest
    double size = 1.5;          ///< times as large or small as the median: beyond children among adults
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("times_median", self.times_median);
        visit("least", self.least);
        visit("size", self.size);
    }
};
static_assert(base::lists_every_field<OutlierOptions>());

struct FarSet {
    std::size_t set = 0;
    std::string reason;  ///< with landmark, value and limit
};

/// Which of several people's landmark sets cannot be taken for faces like the rest: one of their landmarks lies too far
/// from the median of all, after a similarity, they are of another size, or nothing can be fitted to them. The median
/// starts from the set that most others resemble, so that a few bad ones do not move it. Of two sets nobody can tell
/// which is off: then only those to which nothing can be fitted are named.
[[nodiscard]] std::vector<FarSet> sets_far_off(std::span<const geometry::Landmarks> sets,
                                               const OutlierOptions& options = {});

}  // namespace mimik::preprocessing
