#include <tuple>
#include <utility>

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include "bench/peers/nearest_neighbour_peer.h"

namespace mimik::peers {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Numbered = std::pair<Kernel::Point_3, std::size_t>;
using Traits =
    CGAL::Search_traits_adapter<Numbered, CGAL::First_of_pair_property_map<Numbered>, CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;

class Peer final : public NearestNeighbourPeer {
public:
    explicit Peer(std::span<const geometry::Point> points_mm) {
        std::vector<Numbered> numbered;
        numbered.reserve(points_mm.size());
        for (const auto& p : points_mm) numbered.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), numbered.size());
        tree_.insert(numbered.begin(), numbered.end());
        tree_.build();
    }
    [[nodiscard]] std::vector<std::size_t> nearest(std::span<const geometry::Point> queries_mm) const override {
        std::vector<std::size_t> found;
        found.reserve(queries_mm.size());
        for (const auto& q : queries_mm)
            found.push_back(Search(tree_, Kernel::Point_3(q.x(), q.y(), q.z()), 1).begin()->first.second);
        return found;
    }

private:
    Search::Tree tree_;
};

}  // namespace

std::unique_ptr<NearestNeighbourPeer> make_cgal_neighbour_peer(std::span<const geometry::Point> points_mm) {
    return std::make_unique<Peer>(points_mm);
}

}  // namespace mimik::peers
