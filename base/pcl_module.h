#pragma once

#include <cstddef>
#include <cstdint>

// What companions/pcl_module.cpp gives, and who loads it looks up by name: plain C, so that neither side knows the
// other's types. Each gives 0 when done, else what went wrong in `message`, of `message_size` bytes.

extern "C" {

/// pcl::StatisticalOutlierRemoval. @param xyz  3 * count coordinates @param outlier  count bytes: 1 where it is one
using mimik_pcl_outliers_function = int(const double* xyz, std::size_t count, int neighbours, double deviations,
                                        std::uint8_t* outlier, char* message, std::size_t message_size);

/// pcl::EuclideanClusterExtraction, of clusters of any size. @param cluster  count numbers, from 0
using mimik_pcl_clusters_function = int(const double* xyz, std::size_t count, double tolerance, std::uint32_t* cluster,
                                        char* message, std::size_t message_size);
}

namespace mimik::base {

inline constexpr const char* pcl_module_name = "mimik-pcl.so";
inline constexpr const char* pcl_outliers_name = "mimik_pcl_outliers_1";
inline constexpr const char* pcl_clusters_name = "mimik_pcl_clusters_1";

}  // namespace mimik::base
