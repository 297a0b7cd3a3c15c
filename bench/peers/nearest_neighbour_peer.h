#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "geometry/types.h"

namespace mimik::peers {

/// Another implementation of the nearest point of a cloud.
class NearestNeighbourPeer {
public:
    virtual ~NearestNeighbourPeer() = default;
    /// Index of the nearest point of each query, one after another on one thread.
    [[nodiscard]] virtual std::vector<std::size_t> nearest(std::span<const geometry::Point> queries_mm) const = 0;
};

/// nanoflann called as its manual shows, leaves of 10 points (double precision).
[[nodiscard]] std::unique_ptr<NearestNeighbourPeer> make_nanoflann_peer(std::span<const geometry::Point> points_mm);
/// CGAL's Orthogonal_k_neighbor_search (double precision).
[[nodiscard]] std::unique_ptr<NearestNeighbourPeer> make_cgal_neighbour_peer(
    std::span<const geometry::Point> points_mm);
/// PCL's KdTreeFLANN (single precision).
[[nodiscard]] std::unique_ptr<NearestNeighbourPeer> make_pcl_peer(std::span<const geometry::Point> points_mm);

}  // namespace mimik::peers
