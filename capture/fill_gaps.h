#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/fields.h"
#include "capture/marker_sequence.h"
#include "capture/marker_set.h"
#include "geometry/landmarks.h"

namespace mimik::capture {

struct FillOptions {
    /// Longer gaps stay; 0: none is too long. The ends of a gap hold its error down, its middle does not.
    double longest_gap_s = 0;
    /// Markers that carry one whose group the set does not know, or the recording does not have: so many that are
    /// nearest to it where it is first there.
    std::size_t nearest = 6;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("longest_gap_s", self.longest_gap_s);
        visit("nearest", self.nearest);
    }
    /// @throws InputError if the length is below 0, or fewer than three markers are nearest.
    void check() const;
};
static_assert(base::lists_every_field<FillOptions>());

struct Filled {
    MarkerSequence markers;
    std::vector<std::size_t> filled, left;  ///< samples of every marker: filled in, and still missing
    std::vector<std::string> remarks;
};

/// Gaps by the motion of what surrounds them (Sec. 5.2 of Sanchez et al. 2003): from the last frame in which a marker
/// was there, and from the next, its group carries it rigidly to every frame between; the two are blended by time, so
/// that it arrives where it is seen again. Groups are those of the set. Nothing that was seen is changed, and a sample
/// that was filled in carries no other. Left: where fewer than three markers of the group are there.
[[nodiscard]] Filled fill_gaps(const MarkerSequence& sequence, const MarkerSet& set = builtin_marker_set(),
                               const FillOptions& options = {});

struct Derived {
    MarkerSequence markers;            ///< with the derived ones behind the others
    std::vector<std::string> derived;  ///< their names
    std::vector<std::string> remarks;
};

/// Adds the points of the face that bear no marker: each keeps the place that it has at rest in the frame of its
/// sibling, or moves with the rigid motion of its group. @param rest  where they are in one pose of the same head, and
/// the markers they hang on, too: labels on a mesh, or on a scan. Those that `rest` does not have are not made.
[[nodiscard]] Derived derive_markers(const MarkerSequence& sequence, const geometry::Landmarks& rest,
                                     const MarkerSet& set = builtin_marker_set());

}  // namespace mimik::capture
