#include <nanoflann.hpp>

#include "bench/peers/nearest_neighbour_peer.h"

namespace mimik::peers {
namespace {

struct Cloud {
    std::vector<geometry::Point> points;
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return points[i][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    [[nodiscard]] bool kdtree_get_bbox(Box&) const {
        return false;
    }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;

class Peer final : public NearestNeighbourPeer {
public:
    explicit Peer(std::span<const geometry::Point> points_mm)
        : cloud_{{points_mm.begin(), points_mm.end()}},
          tree_(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}
    [[nodiscard]] std::vector<std::size_t> nearest(std::span<const geometry::Point> queries_mm) const override {
        std::vector<std::size_t> found;
        found.reserve(queries_mm.size());
        for (const auto& q : queries_mm) {
            std::uint32_t index = 0;
            double squared = 0;
            tree_.knnSearch(q.data(), 1, &index, &squared);
            found.push_back(index);
        }
        return found;
    }

private:
    Cloud cloud_;
    Tree tree_;
};

}  // namespace

std::unique_ptr<NearestNeighbourPeer> make_nanoflann_peer(std::span<const geometry::Point> points_mm) {
    return std::make_unique<Peer>(points_mm);
}

}  // namespace mimik::peers
