#include "geometry/crowded_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Eigenvalues>

#include "geometry/weld.h"

namespace mimik::geometry {
namespace {

Corners corners_of(std::span<const Point> vertices_mm, const Triangle& t) {
    return {vertices_mm[t[0]], vertices_mm[t[1]] - vertices_mm[t[0]], vertices_mm[t[2]] - vertices_mm[t[0]]};
}

/// The bit of CrowdedSurface::hub_features_ of the corner or edge on which a foot lies; 0 inside.
unsigned feature_of(const Foot& foot) {
    if (foot.edge < 0) return 0;
    const double s = foot.edge == 0 ? foot.b : foot.c;
    constexpr std::array<std::array<unsigned, 2>, 3> ends = {{{0, 1}, {0, 2}, {1, 2}}};
    const auto edge = static_cast<std::size_t>(foot.edge);
    if (s == 0.0) return 1U << ends[edge][0];
    if (s == 1.0) return 1U << ends[edge][1];
    return 8U << edge;
}

}  // namespace

bool is_crowded(std::span<const Point> vertices_mm, std::span<const Triangle> triangles) {
    constexpr std::size_t boxes = 512, probes = 64;
    constexpr std::size_t least = 4096;     // fewer are measured quickly, whatever their shape
    constexpr double crowd = 128;           // boxes over one place, on average; of a scan about five
    constexpr std::size_t least_hits = 16;  // below it chance would decide
    if (triangles.size() < least) return false;
    std::array<std::size_t, boxes> sample{};
    std::array<Eigen::Array3d, boxes> low, high;
    for (std::size_t k = 0; k < boxes; ++k) {
        sample[k] = k * triangles.size() / boxes;
        const auto& [a, b, c] = triangles[sample[k]];
        low[k] = vertices_mm[a].cwiseMin(vertices_mm[b]).cwiseMin(vertices_mm[c]).array();
        high[k] = vertices_mm[a].cwiseMax(vertices_mm[b]).cwiseMax(vertices_mm[c]).array();
    }
    std::size_t hits = 0;
    for (std::size_t p = 0; p < probes; ++p) {
        const std::size_t probe = (2 * p + 1) * triangles.size() / (2 * probes);
        const auto& [a, b, c] = triangles[probe];
        const Eigen::Array3d middle = ((vertices_mm[a] + vertices_mm[b] + vertices_mm[c]) / 3.0).array();
        for (std::size_t k = 0; k < boxes; ++k)
            if (sample[k] != probe && (middle >= low[k]).all() && (middle <= high[k]).all()) ++hits;
    }
    return hits >= least_hits &&
           static_cast<double>(hits) * static_cast<double>(triangles.size()) > crowd * boxes * probes;
}

/// Where a query stands to a hub.
struct CrowdedSurface::Standpoint {
    bool edge = false;
    Vector away = Vector::Zero();  // from the hub's corner, or from its edge's line, to the query
    double away_mm = 0;
    std::array<double, 2> inwards_mm{};  // along an edge, from each of its ends towards the other
    double beyond_mm = 0;                // before or behind both ends' planes; 0 beside the edge

    Standpoint(const Hub& hub, std::span<const Point> vertices_mm, const Point& query_mm)
        : edge(hub.first != hub.second), away(query_mm - vertices_mm[hub.first]) {
        if (edge) {
            const Vector whole = vertices_mm[hub.second] - vertices_mm[hub.first], from_first = away;
            const double length = whole.norm();
            inwards_mm[0] = from_first.dot(whole) / length;
            inwards_mm[1] = length - inwards_mm[0];
            away = from_first - inwards_mm[0] / length * whole;
        }
        away_mm = away.norm();
    }
};

namespace {

constexpr double out_of_reach = std::numeric_limits<double>::infinity();
constexpr double slack = 1e-9;  // sines and lengths are rounded by less

/// By how much a direction lies outside a cone: at least, between 0 and 180 degrees.
struct Turn {
    double cosine = 1, sine = 0;
};
template <class Cone>
Turn beyond(const Cone& cone, const Vector& direction, double length) {
    if (cone.cosine < 0 || length == 0) return {};
    const double cosine = direction.dot(cone.axis) / length, sine = direction.cross(cone.axis).norm() / length;
    if (cosine >= cone.cosine) return {};
    return {cosine * cone.cosine + sine * cone.sine, std::max(0.0, sine * cone.cosine - cosine * cone.sine - slack)};
}

}  // namespace

double CrowdedSurface::squared_distance_to(const Node& node, const Point& query_from_origin) {
    const Vector along_axes = node.axes.transpose() * (query_from_origin - node.centre);
    return (along_axes.cwiseAbs() - node.half).cwiseMax(0.0).squaredNorm() * (1 - slack);
}

/// A squared distance that none of a node's triangles is nearer than; infinite if none is nearer than the hub itself.
double CrowdedSurface::bound_about_corner(const Sector& sector, const Standpoint& at) {
    const Turn turn = beyond(sector.cone, at.away, at.away_mm);
    if (turn.cosine < -1e-12 || at.away_mm == 0) return out_of_reach;  // every triangle leads away
    const double aside_mm = turn.sine * at.away_mm;
    return aside_mm * aside_mm * (1 - slack);
}

/// The same about an edge. The nearest that a triangle can be is where its plane is turned about the edge to the query
/// as far as the node allows; there what is left is a distance in that plane.
double CrowdedSurface::bound_about_edge(const Sector& sector, const Standpoint& at) {
    const Turn turn = beyond(sector.cone, at.away, at.away_mm);
    const double height_mm = turn.sine * at.away_mm, across_mm = turn.cosine * at.away_mm;
    const bool beside = at.inwards_mm[0] > 0 && at.inwards_mm[1] > 0;
    if (beside && (turn.cosine < -1e-12 || at.away_mm == 0)) return out_of_reach;
    const double margin_mm = slack * (at.away_mm + std::abs(at.inwards_mm[0]) + std::abs(at.inwards_mm[1]));
    double gap_mm = std::max(-across_mm, across_mm - sector.reach_mm);
    for (std::size_t end = 0; end < 2; ++end) {
        const double inwards_mm = at.inwards_mm[end];
        if (inwards_mm <= 0) {
            if (inwards_mm * sector.cosine[end] + across_mm * sector.sine[end] < -margin_mm) return out_of_reach;
            if (sector.cosine[end] >= 0) gap_mm = std::max(gap_mm, -inwards_mm);
        }
        gap_mm = std::max(gap_mm, across_mm * sector.cosine[end] - inwards_mm * sector.sine[end]);
    }
    gap_mm = std::max(0.0, gap_mm - margin_mm);
    return (height_mm * height_mm + gap_mm * gap_mm) * (1 - slack);
}

void CrowdedSurface::measure_hub(const Hub& hub, std::span<const Point> vertices_mm,
                                 std::span<const Triangle> triangles, const Point& query_mm, Nearest& best) const {
    const Corners t = corners_of(vertices_mm, triangles[hub.triangle]);
    if (hub.first != hub.second) {
        const Foot foot = measure_edge(t, query_mm - t.a, hub.feature);
        const double s = hub.feature == 0 ? foot.b : foot.c;
        if (s > 0.0 && s < 1.0) best.consider(foot, hub.triangle);  // its ends are hubs themselves
        return;
    }
    Foot foot;
    foot.squared_mm2 = (query_mm - vertices_mm[hub.first]).squaredNorm();
    foot.edge = hub.feature == 2 ? 1 : 0;
    foot.b = hub.feature == 1 ? 1.0 : 0.0;
    foot.c = hub.feature == 2 ? 1.0 : 0.0;
    foot.from_a = hub.feature == 0 ? Vector::Zero() : (hub.feature == 1 ? t.ab : t.ac);
    best.consider(foot, hub.triangle);
}

void CrowdedSurface::search(std::span<const Point> vertices_mm, std::span<const Triangle> triangles,
                            const Point& query_mm, std::uint32_t start, Nearest& best, SearchEffort& effort) const {
    std::uint32_t last = no_triangle;
    const auto measure_one = [&](std::uint32_t triangle) {
        if (std::exchange(last, triangle) == triangle) return;  // another piece of the same
        ++effort.triangles;
        const Foot foot = measure(corners_of(vertices_mm, triangles[triangle]), query_mm);
        if ((feature_of(foot) & hub_features_[triangle]) == 0) best.consider(foot, triangle);
    };
    for (const auto& hub : hubs_) measure_hub(hub, vertices_mm, triangles, query_mm, best);
    if (start != no_triangle) measure_one(start);

    struct Entry {
        double bound;
        std::uint32_t node;
    };
    const Point from_origin = query_mm - origin_;
    std::array<Entry, 128> stack;  // one waits per level, and halves of 2^32 items make 32 levels
    for (const auto& group : groups_) {
        const bool around_hub = group.hub != no_hub;
        const Standpoint at(around_hub ? hubs_[group.hub] : Hub{}, vertices_mm, query_mm);
        const auto bound_of = [&](std::uint32_t number) {
            ++effort.boxes;
            const Node& node = nodes_[number];
            const double bound = squared_distance_to(node, from_origin);
            if (!around_hub || bound > best.foot.squared_mm2) return bound;
            const Sector& sector = sectors_[node.sector];
            return std::max(bound, at.edge ? bound_about_edge(sector, at) : bound_about_corner(sector, at));
        };
        std::size_t waiting = 0;
        stack[waiting++] = {bound_of(group.root), group.root};
        while (waiting > 0) {
            const Entry entry = stack[--waiting];
            if (entry.bound > best.foot.squared_mm2) continue;
            const Node& node = nodes_[entry.node];
            if (node.count > 0) {
                for (std::uint32_t k = node.next; k < node.next + node.count; ++k) measure_one(items_[k]);
                continue;
            }
            Entry near{bound_of(entry.node + 1), entry.node + 1}, far{bound_of(node.next), node.next};
            if (far.bound < near.bound) std::swap(near, far);
            if (far.bound <= best.foot.squared_mm2) stack[waiting++] = far;
            if (near.bound <= best.foot.squared_mm2) stack[waiting++] = near;
        }
    }
}

/// Builds the tree; see the class.
class CrowdedSurfaceBuilder {
public:
    CrowdedSurfaceBuilder(std::span<const Point> vertices_mm, std::span<const Triangle> triangles,
                          CrowdedSurface& surface)
        : vertices_(vertices_mm), triangles_(triangles), surface_(surface), welded_(weld(vertices_mm, triangles)) {}

    void build() {
        surface_.origin_ = vertices_[triangles_[0][0]];
        keep_one_of_equal_ones();
        find_hubs();
        std::vector<std::vector<Item>> items(surface_.hubs_.size() + 1);
        for (const auto t : kept_) {
            Item item;
            item.triangle = t;
            items[group_of(t)].push_back(item);
        }
        for (std::uint32_t hub = 0; hub < surface_.hubs_.size(); ++hub) {
            for (auto& item : items[hub]) item.key = direction_key(item.triangle, surface_.hubs_[hub]);
            add_group(items[hub], hub);
        }
        cut_long_ones(items.back());
        add_group(items.back(), CrowdedSurface::no_hub);
    }

private:
    using Hub = CrowdedSurface::Hub;
    using Cone = CrowdedSurface::Cone;
    static constexpr std::uint32_t crowd = 1024;  // triangles at a corner or an edge that make it a hub
    static constexpr std::size_t items_per_leaf = 4, items_per_block = 256;
    static constexpr std::array<std::array<std::size_t, 2>, 3> edge_ends = {{{0, 1}, {0, 2}, {1, 2}}};

    /// A triangle, or the piece of it between two shares of its longest side.
    struct Item {
        std::uint32_t triangle = 0;
        std::uint32_t slot = 0;  // in points_
        float from = 0, to = 1;
        Eigen::Vector3f key = Eigen::Vector3f::Zero();  // where it lies, or which way; only its order counts
    };
    struct PiecePoints {
        std::array<Point, 5> point;
        std::size_t count = 0;
        void add(const Point& p) { point[count++] = p; }
    };
    /// Of corners: what their mean and covariance come from.
    struct Moments {
        double count = 0;
        Vector sum = Vector::Zero();
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        void add(const Point& p) {
            ++count;
            sum += p;
            squares += p * p.transpose();
        }
        void add(const Moments& other) {
            count += other.count;
            sum += other.sum;
            squares += other.squares;
        }
    };

    [[nodiscard]] Triangle welded(std::uint32_t t) const {
        const auto& [a, b, c] = triangles_[t];
        return {welded_[a], welded_[b], welded_[c]};
    }
    [[nodiscard]] Point at(std::uint32_t vertex) const { return vertices_[vertex] - surface_.origin_; }

    /// Triangles with the same corners in the same order are equally far from everything: the first one wins.
    void keep_one_of_equal_ones() {
        kept_.resize(triangles_.size());
        std::iota(kept_.begin(), kept_.end(), 0U);
        std::sort(kept_.begin(), kept_.end(), [&](std::uint32_t s, std::uint32_t t) {
            const Triangle a = welded(s), b = welded(t);
            return a != b ? a < b : s < t;
        });
        const auto same = [&](std::uint32_t s, std::uint32_t t) { return welded(s) == welded(t); };
        kept_.erase(std::unique(kept_.begin(), kept_.end(), same), kept_.end());
        std::sort(kept_.begin(), kept_.end());
    }

    /// Corners first, each with its lowest triangle; then the edges between them.
    void find_hubs() {
        std::vector<std::uint32_t> degree(vertices_.size(), 0);
        hub_at_.assign(vertices_.size(), CrowdedSurface::no_hub);
        for (const auto t : kept_) {
            const Triangle w = welded(t);
            for (std::size_t k = 0; k < 3; ++k)
                if (std::find(w.begin(), w.begin() + k, w[k]) == w.begin() + k) ++degree[w[k]];
        }
        surface_.hub_features_.assign(triangles_.size(), 0);
        std::vector<std::array<std::uint32_t, 3>> edges;  // between hubs, with the triangle
        for (const auto t : kept_) {
            const Triangle w = welded(t);
            for (std::size_t k = 0; k < 3; ++k) {
                if (degree[w[k]] < crowd) continue;
                surface_.hub_features_[t] |= static_cast<std::uint8_t>(1U << k);
                if (hub_at_[w[k]] != CrowdedSurface::no_hub) continue;
                hub_at_[w[k]] = static_cast<std::uint32_t>(surface_.hubs_.size());
                surface_.hubs_.push_back({w[k], w[k], t, static_cast<int>(k)});
            }
            for (const auto& [k, l] : edge_ends)
                if (w[k] != w[l] && degree[w[k]] >= crowd && degree[w[l]] >= crowd)
                    edges.push_back({std::min(w[k], w[l]), std::max(w[k], w[l]), t});
        }
        degree_ = std::move(degree);
        add_hub_edges(edges);
    }

    void add_hub_edges(std::vector<std::array<std::uint32_t, 3>>& edges) {
        std::sort(edges.begin(), edges.end());
        for (std::size_t k = 0, end = 0; k < edges.size(); k = end) {
            const auto& [first, second, lowest] = edges[k];
            while (end < edges.size() && edges[end][0] == first && edges[end][1] == second) ++end;
            if (end - k < crowd) continue;
            hub_edges_.push_back({first, second, static_cast<std::uint32_t>(surface_.hubs_.size())});
            for (std::size_t e = k; e < end; ++e)
                surface_.hub_features_[edges[e][2]] |=
                    static_cast<std::uint8_t>(8U << edge_of(edges[e][2], first, second));
            surface_.hubs_.push_back({first, second, lowest, static_cast<int>(edge_of(lowest, first, second))});
        }
    }

    [[nodiscard]] std::size_t edge_of(std::uint32_t t, std::uint32_t first, std::uint32_t second) const {
        const Triangle w = welded(t);
        std::size_t edge = 0;
        while (std::minmax(w[edge_ends[edge][0]], w[edge_ends[edge][1]]) != std::minmax(first, second)) ++edge;
        return edge;
    }

    /// The hub whose cones hold a triangle; the number of hubs if none does.
    [[nodiscard]] std::size_t group_of(std::uint32_t t) const {
        const Triangle w = welded(t);
        for (std::size_t edge = 0; edge < 3; ++edge) {
            if ((surface_.hub_features_[t] >> (3 + edge) & 1U) == 0) continue;
            const auto [first, second] = std::minmax(w[edge_ends[edge][0]], w[edge_ends[edge][1]]);
            const std::array<std::uint32_t, 3> key = {first, second, 0};
            const auto found = std::lower_bound(hub_edges_.begin(), hub_edges_.end(), key);
            // One without a clear direction from the edge has none within the error of the cones.
            if (aside(t, surface_.hubs_[(*found)[2]]).squaredNorm() > 0) return (*found)[2];
        }
        std::size_t best = surface_.hubs_.size();
        std::uint32_t most = 0;
        for (std::size_t k = 0; k < 3; ++k)
            if ((surface_.hub_features_[t] >> k & 1U) != 0 && degree_[w[k]] > most) {
                most = degree_[w[k]];
                best = hub_at_[w[k]];
            }
        // A wide one would open every cone that holds it.
        Vector sum = Vector::Zero();
        double count = 0;
        if (most > 0)
            for_each_direction(t, surface_.hubs_[best].first, [&](const Vector& d) {
                sum += d;
                ++count;
            });
        constexpr double narrow = 0.99;  // 16 degrees
        return sum.norm() < narrow * count || count == 0 ? surface_.hubs_.size() : best;
    }

    /// The unit direction from a hub's edge to the triangle's third corner, at a right angle to the edge; 0 if unclear.
    [[nodiscard]] Vector aside(std::uint32_t t, const Hub& hub) const {
        const Point third = at(third_corner(t, hub)), first = at(hub.first);
        const Vector edge = (at(hub.second) - first).normalized(), to = third - first;
        const Vector away = to - to.dot(edge) * edge;
        return away.norm() > 1e-5 * to.norm() ? away.normalized() : Vector::Zero();
    }

    [[nodiscard]] std::uint32_t third_corner(std::uint32_t t, const Hub& hub) const {
        const Triangle w = welded(t);
        return w[3 - edge_ends[edge_of(t, hub.first, hub.second)][0] - edge_ends[edge_of(t, hub.first, hub.second)][1]];
    }

    /// The unit directions from a hub to the triangle's corners that lie elsewhere.
    template <class Use>
    void for_each_direction(std::uint32_t t, std::uint32_t hub, Use use) const {
        for (const auto v : welded(t))
            if (v != hub) use((at(v) - at(hub)).normalized());
    }

    [[nodiscard]] Eigen::Vector3f direction_key(std::uint32_t t, const Hub& hub) const {
        if (hub.first != hub.second) return aside(t, hub).cast<float>();
        Vector sum = Vector::Zero();
        for_each_direction(t, hub.first, [&](const Vector& d) { sum += d; });
        return sum.normalized().cast<float>();
    }

    /// Long triangles into pieces, so that a box about a few neighbouring ones is no longer than they lie apart: eight
    /// times as many as triangles at most.
    void cut_long_ones(std::vector<Item>& items) const {
        double sum = 0;
        for (const auto& item : items) sum += longest_mm(item.triangle);
        const double step = sum / (7.0 * static_cast<double>(items.size()));
        std::vector<Item> pieces;
        for (const auto& item : items) {
            const double count = step > 0 ? std::clamp(std::ceil(longest_mm(item.triangle) / step), 1.0, 64.0) : 1.0;
            const auto parts = static_cast<int>(count);
            for (int k = 0; k < parts; ++k) {
                Item piece = item;
                piece.from = static_cast<float>(k) / static_cast<float>(parts);
                piece.to = static_cast<float>(k + 1) / static_cast<float>(parts);
                const PiecePoints points = points_of(piece);
                Point middle = Point::Zero();
                for (std::size_t p = 0; p < points.count; ++p) middle += points.point[p];
                piece.key = (middle / static_cast<double>(points.count)).cast<float>();
                pieces.push_back(piece);
            }
        }
        items = std::move(pieces);
    }

    [[nodiscard]] double longest_mm(std::uint32_t t) const {
        const auto& [a, b, c] = triangles_[t];
        return std::sqrt(
            std::max({(vertices_[b] - vertices_[a]).squaredNorm(), (vertices_[c] - vertices_[b]).squaredNorm(),
                      (vertices_[a] - vertices_[c]).squaredNorm()}));
    }

    /// Corners of a piece: on the longest side, and across from it on the two others, with their common end if it lies
    /// between.
    [[nodiscard]] PiecePoints points_of(const Item& item) const {
        const auto& [a, b, c] = triangles_[item.triangle];
        std::array<Point, 3> p = {at(a), at(b), at(c)};
        PiecePoints points;
        if (item.from == 0 && item.to == 1) {
            for (const auto& corner : p) points.add(corner);
            return points;
        }
        while ((p[1] - p[0]).squaredNorm() < std::max((p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()))
            std::rotate(p.begin(), p.begin() + 1, p.end());
        const Vector side = p[1] - p[0];
        const double top = std::clamp((p[2] - p[0]).dot(side) / side.squaredNorm(), 0.0, 1.0);
        for (const double s : {static_cast<double>(item.from), static_cast<double>(item.to)}) {
            points.add(p[0] + s * side);
            if (s < top)
                points.add(p[0] + s / top * (p[2] - p[0]));
            else
                points.add(top < 1 ? Point(p[2] + (s - top) / (1 - top) * (p[1] - p[2])) : p[2]);
        }
        if (item.from < top && top < item.to) points.add(p[2]);
        return points;
    }

    void add_group(std::vector<Item>& items, std::uint32_t hub) {
        if (items.empty()) return;
        surface_.groups_.push_back({static_cast<std::uint32_t>(surface_.nodes_.size()), hub});
        add_node(items, hub);
    }

    /// Small nodes are fitted to the corners of their items; larger ones to the boxes and sectors of their children,
    /// which is quicker and loses little where little is left out anyway.
    Moments add_node(std::span<Item> items, std::uint32_t hub) {
        const std::size_t number = surface_.nodes_.size();
        surface_.nodes_.emplace_back();
        const bool small = items.size() <= items_per_block;
        if (hub != CrowdedSurface::no_hub) {
            surface_.nodes_[number].sector = static_cast<std::uint32_t>(surface_.sectors_.size());
            surface_.sectors_.emplace_back();
            if (small) surface_.sectors_.back() = sector_of(items, surface_.hubs_[hub]);
        }
        Moments moments;
        if (small) {
            if (items_in_block_ == 0) compute_points(items);
            items_in_block_ += items.size();
            moments = fit_to_items(items, surface_.nodes_[number]);
        }
        if (items.size() <= items_per_leaf) {
            surface_.nodes_[number].next = static_cast<std::uint32_t>(surface_.items_.size());
            surface_.nodes_[number].count = static_cast<std::uint32_t>(items.size());
            for (const auto& item : items) surface_.items_.push_back(item.triangle);
        } else {
            halve(items);
            const Moments first = add_node(items.first(items.size() / 2), hub);
            const auto second_number = static_cast<std::uint32_t>(surface_.nodes_.size());
            surface_.nodes_[number].next = second_number;
            const Moments second = add_node(items.subspan(items.size() / 2), hub);
            if (!small) {
                moments = first;
                moments.add(second);
                fit_to_children(moments, surface_.nodes_[number], surface_.nodes_[number + 1],
                                surface_.nodes_[second_number], hub);
            }
        }
        if (small) items_in_block_ -= items.size();
        return moments;
    }

    static void halve(std::span<Item> items) {
        Eigen::Vector3f low = items[0].key, high = low;
        for (const auto& item : items) {
            low = low.cwiseMin(item.key);
            high = high.cwiseMax(item.key);
        }
        Eigen::Index axis = 0;
        (high - low).maxCoeff(&axis);
        const auto middle = static_cast<std::ptrdiff_t>(items.size() / 2);
        std::nth_element(items.begin(), items.begin() + middle, items.end(), [axis](const Item& p, const Item& q) {
            if (p.key[axis] != q.key[axis]) return p.key[axis] < q.key[axis];
            return p.triangle != q.triangle ? p.triangle < q.triangle : p.from < q.from;
        });
    }

    void compute_points(std::span<Item> items) {
        points_.clear();
        for (auto& item : items) {
            item.slot = static_cast<std::uint32_t>(points_.size());
            points_.push_back(points_of(item));
        }
    }

    template <class ForEach>
    static void fit(const Moments& moments, CrowdedSurface::Node& node, ForEach for_each) {
        const Vector mean = moments.sum / moments.count;
        node.axes = upright_axes(moments.squares / moments.count - mean * mean.transpose());
        Vector low = Vector::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for_each([&](const Point& p) {
            const Vector along_axes = node.axes.transpose() * (p - mean);
            low = low.cwiseMin(along_axes);
            high = high.cwiseMax(along_axes);
        });
        node.centre = mean + node.axes * (0.5 * (low + high));
        node.half = 0.5 * (high - low);
        // What rounding may have moved a corner by.
        node.half.array() += 1e-12 * (node.half.sum() + node.centre.cwiseAbs().sum()) + 1e-300;
    }

    [[nodiscard]] Moments fit_to_items(std::span<const Item> items, CrowdedSurface::Node& node) const {
        const auto for_each = [&](auto use) {
            for (const auto& item : items)
                for (std::size_t k = 0; k < points_[item.slot].count; ++k) use(points_[item.slot].point[k]);
        };
        Moments moments;
        for_each([&](const Point& p) { moments.add(p); });
        fit(moments, node, for_each);
        return moments;
    }

    void fit_to_children(const Moments& moments, CrowdedSurface::Node& node, const CrowdedSurface::Node& first,
                         const CrowdedSurface::Node& second, std::uint32_t hub) {
        fit(moments, node, [&](auto use) {
            for (const auto* child : {&first, &second})
                for (unsigned corner = 0; corner < 8; ++corner) {
                    const Vector signs((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1,
                                       (corner & 4U) != 0 ? 1 : -1);
                    use(child->centre + child->axes * signs.cwiseProduct(child->half));
                }
        });
        if (hub == CrowdedSurface::no_hub) return;
        const auto &a = surface_.sectors_[first.sector], &b = surface_.sectors_[second.sector];
        auto& both = surface_.sectors_[node.sector];
        both.reach_mm = std::max(a.reach_mm, b.reach_mm);
        for (std::size_t end = 0; end < 2; ++end) {
            both.cosine[end] = std::min(a.cosine[end], b.cosine[end]);
            both.sine[end] = a.cosine[end] < b.cosine[end] ? a.sine[end] : b.sine[end];
        }
        both.cone = around(a.cone, b.cone);
    }

    /// Eigenvectors of a covariance, at right angles to one another to the last bit or two.
    [[nodiscard]] static Eigen::Matrix3d upright_axes(const Eigen::Matrix3d& covariance) {
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
        solver.computeDirect(covariance);
        Vector first = solver.eigenvectors().col(2);
        if (!first.allFinite() || first.squaredNorm() < 0.5) first = Vector::UnitX();
        first.normalize();
        Vector second = solver.eigenvectors().col(1);
        second -= second.dot(first) * first;
        if (!second.allFinite() || second.squaredNorm() < 0.25) second = first.unitOrthogonal();
        second -= second.dot(first) * first;
        second.normalize();
        Eigen::Matrix3d axes;
        axes << first, second, first.cross(second);
        return axes;
    }

    [[nodiscard]] CrowdedSurface::Sector sector_of(std::span<const Item> items, const Hub& hub) const {
        CrowdedSurface::Sector sector;
        if (hub.first == hub.second) {
            sector.cone = cone_of([&](auto use) {
                for (const auto& item : items) for_each_direction(item.triangle, hub.first, use);
            });
            return sector;
        }
        sector.cone = cone_of([&](auto use) {
            for (const auto& item : items) use(aside(item.triangle, hub));
        });
        const Vector edge = (at(hub.second) - at(hub.first)).normalized();
        for (const auto& item : items) {
            const Point third = at(third_corner(item.triangle, hub));
            const std::array<Vector, 2> from = {third - at(hub.first), third - at(hub.second)};
            sector.reach_mm = std::max(sector.reach_mm, edge.cross(from[0]).norm());
            for (std::size_t end = 0; end < 2; ++end) {
                const double cosine = (end == 0 ? 1 : -1) * edge.dot(from[end]) / from[end].norm();
                if (cosine < sector.cosine[end]) {
                    sector.cosine[end] = cosine;
                    sector.sine[end] = edge.cross(from[end]).norm() / from[end].norm();
                }
            }
        }
        return sector;
    }

    template <class ForEach>
    [[nodiscard]] static Cone cone_of(ForEach for_each) {
        Cone cone;
        Vector sum = Vector::Zero();
        for_each([&](const Vector& d) { sum += d; });
        if (sum.norm() < 1e-6) return cone;
        cone.axis = sum.normalized();
        double least = 1, most = 0;
        for_each([&](const Vector& d) {
            least = std::min(least, d.dot(cone.axis));
            most = std::max(most, d.cross(cone.axis).norm());
        });
        if (least > 1e-6) open(cone, most);
        return cone;
    }

    static void open(Cone& cone, double sine) {
        cone.sine = std::min(1.0, sine + 1e-11);
        cone.cosine = std::sqrt(1 - cone.sine * cone.sine);
    }

    /// A cone that holds two others.
    [[nodiscard]] static Cone around(const Cone& a, const Cone& b) {
        Cone both;
        const Vector sum = a.axis + b.axis;
        if (a.cosine < 0 || b.cosine < 0 || sum.norm() < 1e-3) return both;
        both.axis = sum.normalized();
        double angle = 0;
        for (const auto* cone : {&a, &b})
            angle = std::max(angle, std::atan2(both.axis.cross(cone->axis).norm(), both.axis.dot(cone->axis)) +
                                        std::atan2(cone->sine, cone->cosine));
        if (angle < 1.57) open(both, std::sin(angle));
        return both;
    }

    std::span<const Point> vertices_;
    std::span<const Triangle> triangles_;
    CrowdedSurface& surface_;
    std::vector<std::uint32_t> welded_, kept_, degree_, hub_at_;
    std::vector<PiecePoints> points_;                      // of the block that is at work
    std::size_t items_in_block_ = 0;                       // of the nodes at work
    std::vector<std::array<std::uint32_t, 3>> hub_edges_;  // ends, number of the hub; in order
};

CrowdedSurface::CrowdedSurface(std::span<const Point> vertices_mm, std::span<const Triangle> triangles) {
    CrowdedSurfaceBuilder(vertices_mm, triangles, *this).build();
}

}  // namespace mimik::geometry
