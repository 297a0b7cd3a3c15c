// PCL's cleaning for who asks for it (preprocessing/pcl_cleaning.cpp): a module that is loaded then, since PCL's
// libraries take ten times as long to load as `mimik` takes to start.

#include "base/pcl_module.h"

#include <cstdio>
#include <exception>
#include <limits>

#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;  // of the types that Debian's libraries have compiled

Cloud::Ptr cloud_of(const double* xyz, std::size_t count) {
    Cloud::Ptr cloud(new Cloud);
    cloud->reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        cloud->push_back(
            {static_cast<float>(xyz[3 * i]), static_cast<float>(xyz[3 * i + 1]), static_cast<float>(xyz[3 * i + 2])});
    return cloud;
}

/// No exception leaves the module.
template <class Work>
int guarded(char* message, std::size_t message_size, const Work& work) {
    try {
        work();
        return 0;
    } catch (const std::exception& e) {
        std::snprintf(message, message_size, "%s", e.what());
    } catch (...) {
        std::snprintf(message, message_size, "PCL threw something unknown");
    }
    return 1;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) mimik_pcl_outliers_function mimik_pcl_outliers_1;
__attribute__((visibility("default"))) mimik_pcl_clusters_function mimik_pcl_clusters_1;

int mimik_pcl_outliers_1(const double* xyz, std::size_t count, int neighbours, double deviations, std::uint8_t* outlier,
                         char* message, std::size_t message_size) {
    return guarded(message, message_size, [&] {
        pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
        filter.setInputCloud(cloud_of(xyz, count));
        filter.setMeanK(neighbours);
        filter.setStddevMulThresh(deviations);
        pcl::Indices kept;
        filter.filter(kept);
        for (std::size_t i = 0; i < count; ++i) outlier[i] = 1;
        for (const auto i : kept) outlier[i] = 0;
    });
}

int mimik_pcl_clusters_1(const double* xyz, std::size_t count, double tolerance, std::uint32_t* cluster, char* message,
                         std::size_t message_size) {
    return guarded(message, message_size, [&] {
        pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
        const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(false));
        extraction.setInputCloud(cloud_of(xyz, count));
        extraction.setSearchMethod(tree);
        extraction.setClusterTolerance(tolerance);
        extraction.setMinClusterSize(1);
        extraction.setMaxClusterSize(std::numeric_limits<pcl::uindex_t>::max());
        std::vector<pcl::PointIndices> clusters;
        extraction.extract(clusters);
        for (std::size_t c = 0; c < clusters.size(); ++c)
            for (const auto i : clusters[c].indices) cluster[i] = static_cast<std::uint32_t>(c);
    });
}
}
