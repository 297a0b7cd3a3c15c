// PCL's registration is templates that Debian's libraries have not compiled: this is the one file that does.
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include "bench/peers/pcl_judges.h"

namespace mimik::peers {

geometry::Transform align_with_pcl(std::span<const geometry::Point> source_mm,
                                   std::span<const geometry::Point> target_mm, double max_distance_mm,
                                   int max_iterations) {
    const auto cloud_of = [](std::span<const geometry::Point> points) {
        const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
        for (const auto& p : points)
            cloud->push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
        return cloud;
    };
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    icp.setInputSource(cloud_of(source_mm));
    icp.setInputTarget(cloud_of(target_mm));
    icp.setMaxCorrespondenceDistance(max_distance_mm);
    icp.setMaximumIterations(max_iterations);
    icp.setTransformationEpsilon(1e-10);
    icp.setEuclideanFitnessEpsilon(1e-10);
    pcl::PointCloud<pcl::PointXYZ> moved;
    icp.align(moved);
    return geometry::Transform(icp.getFinalTransformation().cast<double>());
}

}  // namespace mimik::peers
