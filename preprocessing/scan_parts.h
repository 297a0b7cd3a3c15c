#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/range_scan.h"
#include "geometry/vertex_mask.h"

// What both ways of cleaning do with the parts of a scan that they found.

namespace mimik::preprocessing {

inline constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

/// The parts of a scan, and which of them are the face.
class ScanParts {
public:
    /// @param part_of  of each point: a number below the count of points, or no_part
    /// @param counts   points at a place that another one stands for are not counted; one per point
    /// @param min_part parts smaller than this share of the largest in front are stray
    ScanParts(const geometry::RangeScan& scan, std::vector<std::uint32_t> part_of, const geometry::VertexMask& counts,
              double min_part);

    /// The points of stray parts.
    [[nodiscard]] geometry::VertexMask stray_points() const;
    [[nodiscard]] std::size_t stray_parts() const;

private:
    void find_face();
    [[nodiscard]] double depth_mm(std::size_t part) const {
        return depth_sum_[part] / static_cast<double>(size_[part]);
    }
    [[nodiscard]] bool in_front(std::size_t part) const;
    [[nodiscard]] bool stays(std::size_t part) const;

    std::vector<std::uint32_t> part_of_;
    std::vector<std::size_t> size_;  // 0 for what is no part
    std::vector<double> depth_sum_;
    double min_part_, front_mm_ = -std::numeric_limits<double>::infinity();
    std::size_t face_size_ = 0;
};

}  // namespace mimik::preprocessing
