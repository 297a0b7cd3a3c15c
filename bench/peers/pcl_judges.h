#pragma once

#include <span>
#include <vector>

#include "geometry/types.h"

// PCL beside our own code: a judge in the tests, a rival in the benchmarks. In single precision, as PCL works.

namespace mimik::peers {

/// pcl::IterativeClosestPoint, point to point, until it stands still: target_from_source.
[[nodiscard]] geometry::Transform align_with_pcl(std::span<const geometry::Point> source_mm,
                                                 std::span<const geometry::Point> target_mm, double max_distance_mm,
                                                 int max_iterations);

/// pcl::NormalEstimation: of the plane through each point's nearest neighbours, towards +z.
[[nodiscard]] std::vector<geometry::Vector> normals_with_pcl(std::span<const geometry::Point> points_mm,
                                                             int neighbours);

}  // namespace mimik::peers
