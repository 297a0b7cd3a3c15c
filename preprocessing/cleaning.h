#pragma once

#include <cstddef>

#include "base/fields.h"
#include "geometry/range_scan.h"

namespace mimik::preprocessing {

struct CleaningOptions {
    double spike_mm = 4.0;     ///< a point this far (in z) from the median of its neighbours is a spike; the steepest
                               ///< surface that a scanner of 0.8 mm spacing still sees changes by less per point
    double max_jump_mm = 6.0;  ///< neighbours farther apart than this, and joined by no face, belong to different parts
    double min_part = 0.05;    ///< parts smaller than this share of the largest are stray (hair tufts, collar)
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("spike_mm", self.spike_mm);
        visit("max_jump_mm", self.max_jump_mm);
        visit("min_part", self.min_part);
    }
    void check() const;
};
static_assert(base::lists_every_field<CleaningOptions>());

struct CleaningReport {
    std::size_t points = 0;        ///< measured points that came in
    std::size_t spikes = 0;        ///< left out
    std::size_t stray_points = 0;  ///< left out with their stray parts
    std::size_t stray_parts = 0;
    std::size_t kept = 0;
};

/// Leaves out spikes and parts that do not hang together with the face. In an organised scan the points left out become
/// NaN; a cloud or mesh loses them (and the faces that used them). Neighbours are the lattice's 24 (two rings), for a
/// mesh the ends of its edges (whatever their length; a spike is then also farther off than twice their mean), for a
/// cloud the 24 nearest points within three times its median spacing. Points at exactly the same place count once. Of
/// the parts, the largest and those of at least `min_part` of it stay, but a part that lies wholly behind the largest
/// by more than 150 mm is background whatever its size.
/// @throws InputError if nothing is left.
[[nodiscard]] geometry::RangeScan clean(const geometry::RangeScan& scan, const CleaningOptions& options = {},
                                        CleaningReport* report = nullptr);

}  // namespace mimik::preprocessing
