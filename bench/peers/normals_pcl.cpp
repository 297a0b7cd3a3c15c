#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include "bench/peers/pcl_judges.h"

namespace mimik::peers {

std::vector<geometry::Vector> normals_with_pcl(std::span<const geometry::Point> points_mm, int neighbours) {
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
    for (const auto& p : points_mm)
        cloud->push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud);
    const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(false));
    estimation.setSearchMethod(tree);
    estimation.setKSearch(neighbours);
    estimation.setViewPoint(0, 0, 1e4F);  // the scanner's side
    pcl::PointCloud<pcl::Normal> found;
    estimation.compute(found);
    std::vector<geometry::Vector> normals;
    normals.reserve(found.size());
    for (const auto& n : found) normals.emplace_back(n.normal_x, n.normal_y, n.normal_z);
    return normals;
}

}  // namespace mimik::peers
