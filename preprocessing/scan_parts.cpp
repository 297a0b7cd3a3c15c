#include "preprocessing/scan_parts.h"

#include <algorithm>
#include <utility>

namespace mimik::preprocessing {

using geometry::RangeScan;

namespace {

constexpr double background_depth_mm = 150.0;  // a head is about 200 mm deep, and a scanner sees its front half

}  // namespace

ScanParts::ScanParts(const RangeScan& scan, std::vector<std::uint32_t> part_of, const geometry::VertexMask& counts,
                     double min_part)
    : part_of_(std::move(part_of)),
      size_(scan.points_mm.size(), 0),
      depth_sum_(scan.points_mm.size(), 0.0),
      min_part_(min_part) {
    for (std::size_t i = 0; i < part_of_.size(); ++i)
        if (part_of_[i] != no_part && counts[i]) {
            ++size_[part_of_[i]];
            depth_sum_[part_of_[i]] += scan.points_mm[i].z();
        }
    find_face();
}

/// The face is the part in front: among the large parts, background lies far behind.
void ScanParts::find_face() {
    const std::size_t most = *std::max_element(size_.begin(), size_.end());
    for (std::size_t i = 0; i < size_.size(); ++i)
        if (size_[i] > 0 && static_cast<double>(size_[i]) >= 0.2 * static_cast<double>(most))
            front_mm_ = std::max(front_mm_, depth_mm(i));
    for (std::size_t i = 0; i < size_.size(); ++i)
        if (size_[i] > 0 && in_front(i)) face_size_ = std::max(face_size_, size_[i]);
}

bool ScanParts::in_front(std::size_t part) const { return depth_mm(part) >= front_mm_ - background_depth_mm; }

bool ScanParts::stays(std::size_t part) const {
    return static_cast<double>(size_[part]) >= min_part_ * static_cast<double>(face_size_) && in_front(part);
}

geometry::VertexMask ScanParts::stray_points() const {
    geometry::VertexMask stray(part_of_.size(), 0);
    for (std::size_t i = 0; i < part_of_.size(); ++i)
        if (part_of_[i] != no_part && !stays(part_of_[i])) stray[i] = 1;
    return stray;
}

std::size_t ScanParts::stray_parts() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < size_.size(); ++i) count += size_[i] > 0 && !stays(i) ? 1 : 0;
    return count;
}

}  // namespace mimik::preprocessing
