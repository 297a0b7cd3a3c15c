#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include "bench/peers/nearest_neighbour_peer.h"

namespace mimik::peers {
namespace {

pcl::PointXYZ to_pcl(const geometry::Point& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

class Peer final : public NearestNeighbourPeer {
public:
    explicit Peer(std::span<const geometry::Point> points_mm) {
        const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
        for (const auto& p : points_mm) cloud->push_back(to_pcl(p));
        tree_.setInputCloud(cloud);
    }
    [[nodiscard]] std::vector<std::size_t> nearest(std::span<const geometry::Point> queries_mm) const override {
        std::vector<std::size_t> found;
        found.reserve(queries_mm.size());
        pcl::Indices index(1);
        std::vector<float> squared(1);
        for (const auto& q : queries_mm) {
            tree_.nearestKSearch(to_pcl(q), 1, index, squared);
            found.push_back(static_cast<std::size_t>(index[0]));
        }
        return found;
    }

private:
    pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
};

}  // namespace

std::unique_ptr<NearestNeighbourPeer> make_pcl_peer(std::span<const geometry::Point> points_mm) {
    return std::make_unique<Peer>(points_mm);
}

}  // namespace mimik::peers
