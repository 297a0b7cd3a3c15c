#include "geometry/point_index.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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
    std::vector<std::size_t> number;  // the caller's index of each

    // nanoflann's names.
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t slot, std::size_t axis) const {
        return points[slot][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    [[nodiscard]] bool kdtree_get_bbox(Box&) const {
        return false;
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
    Slot slot = 0;
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
        const Candidate candidate{squared, cloud.number[slot], slot};
        if (found.size() == capacity) {
            if (!(candidate < found.front())) return true;
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
        if (squared <= squared_radius) found.push_back({squared, cloud.number[slot], slot});
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
    Cloud cloud{{points_mm.begin(), points_mm.end()}, {}};
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
constexpr std::size_t queries_per_piece = 1024;  // about 0.2 ms of work

}  // namespace

struct PointIndex::Impl {
    Cloud cloud;
    Tree tree;

    explicit Impl(std::span<const Point> points_mm)
        : cloud(checked_cloud(points_mm)), tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(points_per_leaf)) {
        for (std::size_t slot = 0; slot < points_mm.size(); ++slot) {
            cloud.number[slot] = tree.vAcc[slot];
            cloud.points[slot] = points_mm[tree.vAcc[slot]];
            tree.vAcc[slot] = static_cast<Slot>(slot);
        }
    }

    template <class Result>
    void search(Result& result, const Point& query_mm) const {
        tree.findNeighbors(result, query_mm.data(), nanoflann::SearchParams());
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
    result.found.reserve(std::min(k, impl_->cloud.points.size()));
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

}  // namespace mimik::geometry
