#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/range_scan.h"
#include "geometry/vertex_mask.h"

namespace mimik::geometry {

/// Which points of a scan lie beside which: the lattice's 24 (two rings), for a mesh the ends of its edges, for a cloud
/// the 24 nearest points within three times its median spacing. Of points at exactly the same place (a texture's seam,
/// or what a camera writes for nothing) the first stands for all; in a lattice every point stands for itself.
struct ScanNeighbours {
    std::vector<std::size_t> first;  ///< of point i: entries [first[i], first[i + 1]) of `index`
    std::vector<std::uint32_t> index;
    std::vector<std::uint32_t> first_of_place;  ///< per point

    [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t point) const {
        return std::span(index).subspan(first[point], first[point + 1] - first[point]);
    }
};
[[nodiscard]] ScanNeighbours scan_neighbours(const RangeScan& scan);

/// 1 for a point that lies farther than `spike_mm` in z from the median of its neighbours; of a mesh also farther than
/// twice their mean distance in x-y, since where it is coarse a steep surface falls by more from vertex to vertex. A
/// point with fewer than three neighbours cannot be judged and is none.
[[nodiscard]] VertexMask find_spikes(const RangeScan& scan, const ScanNeighbours& neighbours, double spike_mm);

}  // namespace mimik::geometry
