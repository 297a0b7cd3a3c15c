#include "preprocessing/cleaning.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/disjoint_sets.h"
#include "geometry/leave_out_points.h"
#include "geometry/spikes.h"
#include "preprocessing/scan_parts.h"

namespace mimik::preprocessing {

using geometry::RangeScan;

void CleaningOptions::check() const {
    if (!(spike_mm > 0)) throw InputError(fmt::format("spike_mm is {}; give more than 0", spike_mm));
    if (!(max_jump_mm > 0)) throw InputError(fmt::format("max_jump_mm is {}; give more than 0", max_jump_mm));
    if (!(min_part >= 0 && min_part <= 1))
        throw InputError(fmt::format("min_part is {}; give a share between 0 and 1", min_part));
}

namespace {

/// Points that hang together: neighbours that lie close in space. What the faces of a mesh join hangs together, however
/// coarse they are.
geometry::DisjointSets joined_points(const RangeScan& scan, const geometry::ScanNeighbours& neighbours,
                                     const geometry::VertexMask& dropped, double max_jump_mm) {
    const bool has_faces = !scan.organised() && scan.faces.size() > 0;
    const auto n = static_cast<std::uint32_t>(scan.points_mm.size());
    geometry::DisjointSets sets(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        if (dropped[i] || !scan.valid(i)) continue;
        for (const auto other : neighbours[i]) {
            // A lattice's neighbours are each other's; the nearest of a cloud need not be.
            if ((scan.organised() && other > i) || dropped[other] || sets.share_parent(other, i)) continue;
            if (!has_faces && (scan.points_mm[i] - scan.points_mm[other]).squaredNorm() > max_jump_mm * max_jump_mm)
                continue;
            sets.join(i, other);
        }
    }
    return sets;
}

}  // namespace

RangeScan clean(const RangeScan& scan, const CleaningOptions& options, CleaningReport* report) {
    options.check();
    CleaningReport counts;
    const std::size_t n = scan.points_mm.size();
    for (std::size_t i = 0; i < n; ++i) counts.points += scan.valid(i) ? 1 : 0;
    if (counts.points == 0) throw InputError("the scan holds no measured point");

    const auto neighbours = geometry::scan_neighbours(scan);
    auto dropped = geometry::find_spikes(scan, neighbours, options.spike_mm);
    counts.spikes = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
    auto sets = joined_points(scan, neighbours, dropped, options.max_jump_mm);
    std::vector<std::uint32_t> part_of(n, no_part);
    geometry::VertexMask counted(n, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
        if (dropped[i] || !scan.valid(i)) continue;
        part_of[i] = sets.root(i);
        counted[i] = neighbours.first_of_place[i] == i;  // a place counts once
    }
    const ScanParts parts(scan, std::move(part_of), counted, options.min_part);
    const auto stray = parts.stray_points();
    counts.stray_parts = parts.stray_parts();
    counts.stray_points = static_cast<std::size_t>(std::count(stray.begin(), stray.end(), 1));
    for (std::size_t i = 0; i < n; ++i)
        if (stray[i]) dropped[i] = 1;
    counts.kept = counts.points - counts.spikes - counts.stray_points;
    if (counts.kept == 0) throw InputError("cleaning left no point; raise spike_mm or lower min_part");
    if (report) *report = counts;
    return geometry::leave_out_points(scan, dropped);
}

}  // namespace mimik::preprocessing
