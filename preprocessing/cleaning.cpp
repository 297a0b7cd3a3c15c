#include "preprocessing/cleaning.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/disjoint_sets.h"
#include "geometry/leave_out_points.h"
#include "geometry/spikes.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::RangeScan;

void CleaningOptions::check() const {
    if (!(spike_mm > 0)) throw InputError(fmt::format("spike_mm is {}; give more than 0", spike_mm));
    if (!(max_jump_mm > 0)) throw InputError(fmt::format("max_jump_mm is {}; give more than 0", max_jump_mm));
    if (!(min_part >= 0 && min_part <= 1))
        throw InputError(fmt::format("min_part is {}; give a share between 0 and 1", min_part));
}

namespace {

constexpr double background_depth_mm = 150.0;  // a head is about 200 mm deep, and a scanner sees its front half

constexpr std::uint8_t spike = 1, stray = 2;  // why a point is dropped

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

/// The parts of a scan, each under the lowest of its points, and which of them are the face.
class Parts {
public:
    Parts(const RangeScan& scan, const geometry::ScanNeighbours& neighbours, const geometry::VertexMask& dropped,
          const CleaningOptions& options)
        : sets_(joined_points(scan, neighbours, dropped, options.max_jump_mm)),
          size_(scan.points_mm.size(), 0),
          depth_sum_(scan.points_mm.size(), 0.0),
          min_part_(options.min_part) {
        for (std::uint32_t i = 0; i < size_.size(); ++i)
            if (!dropped[i] && scan.valid(i) && neighbours.first_of_place[i] == i) {  // a place counts once
                const auto part = sets_.root(i);
                ++size_[part];
                depth_sum_[part] += scan.points_mm[i].z();
            }
        find_face();
    }

    [[nodiscard]] std::uint32_t of(std::uint32_t point) { return sets_.root(point); }
    [[nodiscard]] bool is_one(std::uint32_t part) const { return size_[part] > 0; }
    [[nodiscard]] bool stays(std::uint32_t part) const {
        return static_cast<double>(size_[part]) >= min_part_ * static_cast<double>(face_size_) && in_front(part);
    }

private:
    /// The face is the part in front: among the large parts, background lies far behind.
    void find_face() {
        const std::size_t most = *std::max_element(size_.begin(), size_.end());
        for (std::size_t i = 0; i < size_.size(); ++i)
            if (size_[i] > 0 && static_cast<double>(size_[i]) >= 0.2 * static_cast<double>(most))
                front_mm_ = std::max(front_mm_, depth_mm(i));
        for (std::size_t i = 0; i < size_.size(); ++i)
            if (size_[i] > 0 && in_front(i)) face_size_ = std::max(face_size_, size_[i]);
    }
    [[nodiscard]] double depth_mm(std::size_t part) const {
        return depth_sum_[part] / static_cast<double>(size_[part]);
    }
    [[nodiscard]] bool in_front(std::size_t part) const { return depth_mm(part) >= front_mm_ - background_depth_mm; }

    geometry::DisjointSets sets_;
    std::vector<std::size_t> size_;  // 0 for what is no part
    std::vector<double> depth_sum_;
    double min_part_, front_mm_ = -std::numeric_limits<double>::infinity();
    std::size_t face_size_ = 0;
};

}  // namespace

RangeScan clean(const RangeScan& scan, const CleaningOptions& options, CleaningReport* report) {
    options.check();
    CleaningReport counts;
    const std::size_t n = scan.points_mm.size();
    for (std::size_t i = 0; i < n; ++i) counts.points += scan.valid(i) ? 1 : 0;
    if (counts.points == 0) throw InputError("the scan holds no measured point");

    const auto neighbours = geometry::scan_neighbours(scan);
    auto dropped = geometry::find_spikes(scan, neighbours, options.spike_mm);
    counts.spikes = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), spike));
    Parts parts(scan, neighbours, dropped, options);
    for (std::uint32_t i = 0; i < n; ++i) {
        if (parts.is_one(i) && !parts.stays(i)) ++counts.stray_parts;
        if (dropped[i] || !scan.valid(i) || parts.stays(parts.of(i))) continue;
        dropped[i] = stray;
        ++counts.stray_points;
    }
    counts.kept = counts.points - counts.spikes - counts.stray_points;
    if (counts.kept == 0) throw InputError("cleaning left no point; raise spike_mm or lower min_part");
    if (report) *report = counts;
    return geometry::leave_out_points(scan, dropped);
}

}  // namespace mimik::preprocessing
