#include "geometry/point_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nanoflann.hpp>

#include "base/errors.h"
#include "base/parallel.h"

namespace mimik::geometry {
namespace {

using Slot = std::uint32_t;  // place of a point in leaf order

struct Cloud {
    std::vector<Point> points;        // in leaf order, so that a leaf is one piece of memory
    std::vector<std::size_t> number;  // the caller's index of each; of a pile the lowest
    // Only where points lie in piles, each of which is one point here: slot s stands for the caller's indices
    // piled[pile_begin[s]] to piled[pile_begin[s + 1] - 1], in ascending order.
    std::vector<std::size_t> pile_begin, piled;

    // nanoflann's names.
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t slot, std::size_t axis) const {
        return points[slot][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    [[nodiscard]] bool kdtree_get_bbox(Box&) const {
        return false;
    }

    /// The caller's indices at a place in ascending order, until `use` returns false.
    template <class Use>
    void for_each_at(Slot slot, Use use) const {
        if (pile_begin.empty()) {
            use(number[slot]);
            return;
        }
        for (std::size_t k = pile_begin[slot]; k < pile_begin[slot + 1] && use(piled[k]); ++k) {
        }
    }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud, double, Slot>, Cloud, 3, Slot>;

// The tree drops what is not below the bound and sums its own bounds with rounding: a bound a few ulps wider lets every
// tie through, and the comparison of indices below decides.
double widened(double squared) { return squared * (1 + 1e-14) + std::numeric_limits<double>::denorm_min(); }

struct Candidate {
    double squared = std::numeric_limits<double>::infinity();
    std::size_t number = std::numeric_limits<std::size_t>::max();
    [[nodiscard]] bool operator<(const Candidate& other) const {
        return squared < other.squared || (squared == other.squared && number < other.number);
    }
};

// NOLINTBEGIN(readability-identifier-naming): the result sets have the names that nanoflann calls.
struct NearestOne {
    const Cloud& cloud;
    double squared = std::numeric_limits<double>::infinity();
    double bound = squared;
    Slot slot = 0;
    [[nodiscard]] double worstDist() const { return bound; }
    bool addPoint(double candidate_squared, Slot candidate) {
        if (candidate_squared < squared) {
            squared = candidate_squared;
            bound = widened(squared);
            slot = candidate;
        } else if (candidate_squared == squared && cloud.number[candidate] < cloud.number[slot]) {
            slot = candidate;
        }
        return true;
    }
    [[nodiscard]] static bool full() { return true; }
};

struct NearestFew {
    const Cloud& cloud;
    std::size_t capacity;
    std::vector<Candidate> found;  // a heap, the worst on top
    [[nodiscard]] double worstDist() const {
        return found.size() < capacity ? std::numeric_limits<double>::infinity() : widened(found.front().squared);
    }
    bool addPoint(double squared, Slot slot) {
        cloud.for_each_at(slot, [&](std::size_t number) { return keep({squared, number}); });
        return true;
    }
    /// Whether another at the same place, with a higher index, may be kept, too.
    bool keep(const Candidate& candidate) {
        if (found.size() == capacity) {
            if (!(candidate < found.front())) return false;
            std::pop_heap(found.begin(), found.end());
            found.pop_back();
        }
        found.push_back(candidate);
        std::push_heap(found.begin(), found.end());
        return true;
    }
    [[nodiscard]] static bool full() { return true; }
};

struct WithinRadius {
    const Cloud& cloud;
    double squared_radius;
    std::vector<Candidate> found;
    [[nodiscard]] double worstDist() const { return widened(squared_radius); }
    bool addPoint(double squared, Slot slot) {
        if (squared <= squared_radius)
            cloud.for_each_at(slot, [&](std::size_t number) {
                found.push_back({squared, number});
                return true;
            });
        return true;
    }
    [[nodiscard]] static bool full() { return true; }
};

// NOLINTEND(readability-identifier-naming)

Cloud checked_cloud(std::span<const Point> points_mm) {
    if (points_mm.empty()) throw InputError("point index: there is no point to search; give at least one");
    if (points_mm.size() > std::numeric_limits<Slot>::max())
        throw InputError(fmt::format("point index: {} points are more than it can hold ({})", points_mm.size(),
                                     std::numeric_limits<Slot>::max()));
    Cloud cloud;
    cloud.points.assign(points_mm.begin(), points_mm.end());
    cloud.number.resize(points_mm.size());
    for (std::size_t i = 0; i < points_mm.size(); ++i) {
        if (!points_mm[i].allFinite())
            throw InputError(
                fmt::format("point index: point {} has a coordinate that is not a finite number; leave it out", i));
        cloud.number[i] = i;
    }
    return cloud;
}

void check_query(const Point& query_mm) {
    if (!query_mm.allFinite())
        throw InputError(fmt::format("point index: the query ({}, {}, {}) is not a finite point; leave it out",
                                     query_mm.x(), query_mm.y(), query_mm.z()));
}

std::vector<PointIndex::Neighbour> sorted_neighbours(std::vector<Candidate> found) {
    std::sort(found.begin(), found.end());
    std::vector<PointIndex::Neighbour> neighbours;
    neighbours.reserve(found.size());
    for (const auto& c : found) neighbours.push_back({c.number, std::sqrt(c.squared)});
    return neighbours;
}

constexpr std::size_t points_per_leaf = 16;      // quicker to build than 10, as quick to ask
constexpr std::size_t longest_pile = 8;          // equal points that may lie in a leaf one by one
constexpr std::size_t queries_per_piece = 1024;  // about 0.2 ms of work

}  // namespace

struct PointIndex::Impl {
    Cloud cloud;
    std::size_t size;  // of the caller's points
    std::optional<Tree> tree;

    explicit Impl(std::span<const Point> points_mm) : cloud(checked_cloud(points_mm)), size(points_mm.size()) {
        make_tree();
        for (std::size_t slot = 0; slot < size; ++slot) {
            cloud.number[slot] = tree->vAcc[slot];
            cloud.points[slot] = points_mm[tree->vAcc[slot]];
            tree->vAcc[slot] = static_cast<Slot>(slot);
        }
        // A search for several visits every point that is as near as the last one it keeps, so a pile of n equal points
        // would cost each search n steps. Equal points fill whole leaves: a run of them there betrays a pile.
        if (longest_run() > longest_pile) make_tree_of_piles();
    }

    void make_tree() { tree.emplace(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(points_per_leaf)); }

    [[nodiscard]] std::size_t longest_run() const {
        std::size_t longest = 1;
        for (std::size_t slot = 1, begin = 0; slot < cloud.points.size(); ++slot) {
            if (cloud.points[slot] != cloud.points[slot - 1]) begin = slot;
            longest = std::max(longest, slot + 1 - begin);
        }
        return longest;
    }

    void make_tree_of_piles() {
        std::vector<Slot> order(size);
        std::iota(order.begin(), order.end(), Slot{0});
        const auto place = [&](Slot s) {
            return std::array{cloud.points[s].x(), cloud.points[s].y(), cloud.points[s].z()};
        };
        std::sort(order.begin(), order.end(), [&](Slot a, Slot b) {
            const auto at_a = place(a), at_b = place(b);
            return at_a != at_b ? at_a < at_b : cloud.number[a] < cloud.number[b];
        });
        Cloud piles;
        for (const Slot s : order) {
            if (piles.points.empty() || piles.points.back() != cloud.points[s]) {
                piles.points.push_back(cloud.points[s]);
                piles.pile_begin.push_back(piles.piled.size());
            }
            piles.piled.push_back(cloud.number[s]);
        }
        piles.pile_begin.push_back(size);
        cloud.points = piles.points;
        make_tree();
        cloud.number.resize(piles.points.size());
        for (std::size_t slot = 0; slot < piles.points.size(); ++slot) {
            const Slot from = tree->vAcc[slot];
            tree->vAcc[slot] = static_cast<Slot>(slot);
            cloud.points[slot] = piles.points[from];
            cloud.pile_begin.push_back(cloud.piled.size());
            for (std::size_t k = piles.pile_begin[from]; k < piles.pile_begin[from + 1]; ++k)
                cloud.piled.push_back(piles.piled[k]);
            cloud.number[slot] = cloud.piled[cloud.pile_begin.back()];
        }
        cloud.pile_begin.push_back(size);
    }

    template <class Result>
    void search(Result& result, const Point& query_mm) const {
        tree->findNeighbors(result, query_mm.data(), nanoflann::SearchParams());
    }
};

PointIndex::PointIndex(std::span<const Point> points_mm) : impl_(std::make_unique<Impl>(points_mm)) {}
PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

PointIndex::Neighbour PointIndex::nearest(const Point& query_mm) const {
    check_query(query_mm);
    NearestOne result{impl_->cloud};
    impl_->search(result, query_mm);
    return {impl_->cloud.number[result.slot], std::sqrt(result.squared)};
}

std::vector<PointIndex::Neighbour> PointIndex::nearest(std::span<const Point> queries_mm) const {
    std::vector<Neighbour> neighbours(queries_mm.size());
    base::parallel_for(queries_mm.size(), queries_per_piece, [&](std::size_t begin, std::size_t end) {
        NearestOne result{impl_->cloud};
        for (std::size_t i = begin; i < end; ++i) {
            check_query(queries_mm[i]);
            // Queries that follow one another are often neighbours: the last answer is a first guess that prunes well.
            const Point offset = queries_mm[i] - impl_->cloud.points[result.slot];
            result.squared = offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z();
            result.bound = widened(result.squared);
            impl_->search(result, queries_mm[i]);
            neighbours[i] = {impl_->cloud.number[result.slot], std::sqrt(result.squared)};
        }
    });
    return neighbours;
}

std::vector<PointIndex::Neighbour> PointIndex::nearest(const Point& query_mm, std::size_t k) const {
    check_query(query_mm);
    if (k == 0) return {};
    NearestFew result{impl_->cloud, k, {}};
    result.found.reserve(std::min(k, impl_->size));
    impl_->search(result, query_mm);
    return sorted_neighbours(std::move(result.found));
}

std::vector<PointIndex::Neighbour> PointIndex::within(const Point& query_mm, double radius_mm) const {
    check_query(query_mm);
    if (!(radius_mm >= 0)) throw InputError(fmt::format("point index: radius_mm is {}; give 0 or more", radius_mm));
    WithinRadius result{impl_->cloud, radius_mm * radius_mm, {}};
    impl_->search(result, query_mm);
    return sorted_neighbours(std::move(result.found));
}

std::size_t PointIndex::places() const { return impl_->cloud.points.size(); }

}  // namespace mimik::geometry
