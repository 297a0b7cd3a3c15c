#include "geometry/surface_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"
#include "geometry/box_distance.h"
#include "geometry/crowded_surface.h"
#include "geometry/triangle_foot.h"
#include "geometry/weld.h"

namespace mimik::geometry {
namespace {

constexpr std::size_t width = BoxNode::width;
constexpr double max_coordinate_mm = 1e9;
constexpr std::uint32_t none = no_triangle;

struct Box {
    Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array3f high = Eigen::Array3f::Constant(-std::numeric_limits<float>::infinity());
    void add(const Box& other) {
        low = low.min(other.low);
        high = high.max(other.high);
    }
};

// A float is within half an ulp of the double it stands for; widened by a whole one it is on the safe side of it.
float below(double value) {
    const auto f = static_cast<float>(value);
    return f - std::abs(f) * 1.2e-7F - 1e-30F;
}
float above(double value) {
    const auto f = static_cast<float>(value);
    return f + std::abs(f) * 1.2e-7F + 1e-30F;
}

}  // namespace

struct SurfaceIndex::Impl {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::vector<BoxNode> nodes;
    Point centre = Point::Zero();
    BoxDistances distances = box_distances();
    std::optional<CrowdedSurface> crowded;  // searched in the place of the nodes

    // Only those who ask for borders pay for them.
    mutable std::once_flag border_once;
    mutable std::vector<std::uint8_t> border_edges;  // per triangle: bit k = the edge from corner k to corner k + 1
    mutable std::vector<std::uint8_t> border_vertices;

    Impl(std::span<const Point> vertices_mm, std::span<const Triangle> triangles_)
        : vertices(vertices_mm.begin(), vertices_mm.end()), triangles(triangles_.begin(), triangles_.end()) {
        check();
        build();
        if (is_crowded(vertices, triangles)) crowded.emplace(vertices, triangles);
    }

    void check() const {
        if (triangles.empty())
            throw InputError("the surface has no triangle; give a mesh with faces, not a point cloud");
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (const auto v : triangles[t]) {
                if (v >= vertices.size())
                    throw InputError(fmt::format("triangle {} of the surface names vertex {}, but there are only {}", t,
                                                 v, vertices.size()));
                // Written so that NaN fails too.
                if (!(vertices[v].cwiseAbs().maxCoeff() <= max_coordinate_mm) || !vertices[v].allFinite())
                    throw InputError(
                        fmt::format("vertex {} of the surface is ({}, {}, {}); coordinates must be finite and "
                                    "below 1e9 mm: leave out such triangles",
                                    v, vertices[v].x(), vertices[v].y(), vertices[v].z()));
            }
    }

    struct Item {
        Eigen::Array3f middle;  // sum of the three corners: only its order counts
        std::uint32_t triangle = 0;
    };

    void build() {
        Point low = vertices[triangles[0][0]], high = low;
        for (const auto& t : triangles)
            for (const auto v : t) {
                low = low.cwiseMin(vertices[v]);
                high = high.cwiseMax(vertices[v]);
            }
        centre = 0.5 * (low + high);
        std::vector<Item> items(triangles.size());
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const auto& [a, b, c] = triangles[t];
            items[t] = {(vertices[a] + vertices[b] + vertices[c] - 3.0 * centre).cast<float>().array(), t};
        }
        nodes.reserve(triangles.size() / 7 + 16);
        nodes.emplace_back();
        std::vector<Item> scratch;
        fill(0, items, scratch);
    }

    // Splits at the median of the longest side into `parts` runs of `capacity` items (the last may be shorter).
    static void split(std::span<Item> items, std::uint32_t parts, std::size_t capacity, std::vector<Item>& scratch,
                      std::vector<std::span<Item>>& runs) {
        if (parts == 1) {
            runs.push_back(items);
            return;
        }
        Eigen::Array3f low = items[0].middle, high = low;
        for (const auto& item : items) {
            low = low.min(item.middle);
            high = high.max(item.middle);
        }
        Eigen::Index axis = 0;
        (high - low).maxCoeff(&axis);
        const std::size_t left = parts / 2 * capacity;
        select(items, left, axis, low[axis], high[axis], scratch);
        split(items.first(left), parts / 2, capacity, scratch, runs);
        split(items.subspan(left), parts - parts / 2, capacity, scratch, runs);
    }

    // std::nth_element, with a histogram before it where there are many items: most then move once, without a branch.
    static void select(std::span<Item> items, std::size_t left, Eigen::Index axis, float low, float high,
                       std::vector<Item>& scratch) {
        std::size_t begin = 0, end = items.size();
        const std::int32_t bins = items.size() > 1024 ? 256 : 32;
        const float scale = static_cast<float>(bins) / (high - low);
        if (items.size() > 12 && std::isfinite(scale)) {
            const auto bin_of = [&](const Item& item) {
                return std::min(static_cast<std::int32_t>((item.middle[axis] - low) * scale), bins - 1);
            };
            std::array<std::uint32_t, 256> count;
            std::fill_n(count.begin(), bins, 0U);
            for (const auto& item : items) ++count[static_cast<std::size_t>(bin_of(item))];
            std::int32_t middle = 0;
            while (begin + count[static_cast<std::size_t>(middle)] <= left)
                begin += count[static_cast<std::size_t>(middle++)];
            end = begin + count[static_cast<std::size_t>(middle)];
            std::array<std::size_t, 3> next = {0, begin, end};
            scratch.resize(std::max(scratch.size(), items.size()));
            for (const auto& item : items) {
                const auto bin = bin_of(item);
                scratch[next[static_cast<std::size_t>((bin >= middle) + (bin > middle))]++] = item;
            }
            std::copy_n(scratch.begin(), items.size(), items.begin());
        }
        const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(left), at(end), [axis](const Item& p, const Item& q) {
            return p.middle[axis] != q.middle[axis] ? p.middle[axis] < q.middle[axis] : p.triangle < q.triangle;
        });
    }

    Box fill(std::uint32_t node, std::span<Item> items, std::vector<Item>& scratch) {
        std::array<Box, width> boxes;
        std::array<std::uint32_t, width> children{};
        Box whole;
        std::size_t capacity = 1;
        while (capacity * width < items.size()) capacity *= width;
        const bool leaf = capacity == 1;
        if (leaf) {
            for (std::size_t k = 0; k < items.size(); ++k) {
                const auto t = items[k].triangle;
                const Point a = vertices[triangles[t][0]] - centre, b = vertices[triangles[t][1]] - centre,
                            c = vertices[triangles[t][2]] - centre;
                const Point low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
                for (int axis = 0; axis < 3; ++axis) {
                    boxes[k].low[axis] = below(low[axis]);
                    boxes[k].high[axis] = above(high[axis]);
                }
                children[k] = t;
                whole.add(boxes[k]);
            }
        } else {
            std::vector<std::span<Item>> runs;
            split(items, static_cast<std::uint32_t>((items.size() + capacity - 1) / capacity), capacity, scratch, runs);
            for (std::size_t k = 0; k < runs.size(); ++k) {
                children[k] = static_cast<std::uint32_t>(nodes.size());
                nodes.emplace_back();
                boxes[k] = fill(children[k], runs[k], scratch);
                whole.add(boxes[k]);
            }
        }
        for (std::size_t k = 0; k < width; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                nodes[node].low[axis][k] = boxes[k].low[static_cast<Eigen::Index>(axis)];
                nodes[node].high[axis][k] = boxes[k].high[static_cast<Eigen::Index>(axis)];
            }
        nodes[node].child = children;
        nodes[node].leaf = leaf;
        return whole;
    }

    // Depth first, near children first. `best` may hold an upper bound from a neighbouring query's triangle. A box is
    // left out only if it is strictly farther than the best triangle, so that ties reach the comparison of indices.
    void search(const Point& query, Nearest& best, SearchEffort& effort) const {
        struct Entry {
            float bound;
            std::uint32_t node;
        };
        std::array<float, 3> q_low{}, q_high{};
        for (int axis = 0; axis < 3; ++axis) {
            q_low[static_cast<std::size_t>(axis)] = below(query[axis] - centre[axis]);
            q_high[static_cast<std::size_t>(axis)] = above(query[axis] - centre[axis]);
        }
        float limit = upper(best.foot.squared_mm2);
        std::uint64_t looked_at = 0, measured = 0;
        std::array<Entry, 256> stack;  // at most 7 waiting per level, 11 levels for 2^32 triangles
        std::size_t waiting = 0;
        stack[waiting++] = {0.0F, 0};
        while (waiting > 0) {
            const Entry entry = stack[--waiting];
            if (entry.bound > limit) continue;
            ++looked_at;
            const BoxNode& node = nodes[entry.node];
            alignas(32) std::array<float, width> bound;
            std::uint32_t within = distances(node, q_low.data(), q_high.data(), limit, bound.data());
            if (node.leaf) {
                for (; within != 0; within &= within - 1) {
                    const auto k = static_cast<std::size_t>(std::countr_zero(within));
                    if (bound[k] > limit) continue;
                    const std::uint32_t triangle = node.child[k];
                    if (triangle == best.triangle) continue;
                    ++measured;
                    const Foot foot = measure(corners(triangle), query);
                    if (foot.squared_mm2 < best.foot.squared_mm2 ||
                        (foot.squared_mm2 == best.foot.squared_mm2 && triangle < best.triangle)) {
                        best = {foot, triangle};
                        limit = upper(foot.squared_mm2);
                    }
                }
            } else {
                const std::size_t first = waiting;
                for (; within != 0; within &= within - 1) {
                    const auto k = static_cast<std::size_t>(std::countr_zero(within));
                    std::size_t place = waiting++;
                    for (; place > first && stack[place - 1].bound < bound[k]; --place) stack[place] = stack[place - 1];
                    stack[place] = {bound[k], node.child[k]};
                }
            }
        }
        effort.boxes += looked_at;
        effort.triangles += measured;
    }

    // From the triangle `start` on, if it is one.
    Nearest nearest(const Point& query, std::uint32_t start, SearchEffort& effort) const {
        Nearest best;
        if (crowded) {
            crowded->search(vertices, triangles, query, start, best, effort);
            return best;
        }
        if (start != none) best = {measure(corners(start), query), start};
        search(query, best, effort);
        return best;
    }

    // Never infinite, so that the infinitely far boxes of unused children stay out of any limit.
    static float upper(double squared) {
        return std::min(static_cast<float>(squared) * 1.000001F + 1e-37F, std::numeric_limits<float>::max());
    }

    Corners corners(std::uint32_t triangle) const {
        const auto& [a, b, c] = triangles[triangle];
        return {vertices[a], vertices[b] - vertices[a], vertices[c] - vertices[a]};
    }

    SurfacePoint answer(const Nearest& best) const {
        const auto& [foot, triangle] = best;
        SurfacePoint point;
        point.distance_mm = std::sqrt(foot.squared_mm2);
        point.triangle = triangle;
        point.barycentric = {foot.edge == 2 ? 0.0 : 1.0 - foot.b - foot.c, foot.b, foot.c};
        point.position_mm = vertices[triangles[triangle][0]] + foot.from_a;
        for (int k = 0; k < 3; ++k)  // a corner is returned to the bit
            if (point.barycentric[k] == 1.0)
                point.position_mm = vertices[triangles[triangle][static_cast<std::size_t>(k)]];
        return point;
    }

    void mark_borders() const {
        const auto welded = weld(vertices, triangles);
        // The ends of each edge in order; lists of the edges that start at each vertex, one after another.
        const auto ends = [&](const Triangle& t, std::size_t k) {
            return std::minmax({welded[t[k]], welded[t[(k + 1) % 3]]});
        };
        const auto collapsed = [&](const Triangle& t) {
            return welded[t[0]] == welded[t[1]] || welded[t[1]] == welded[t[2]] || welded[t[2]] == welded[t[0]];
        };
        std::vector<std::uint32_t> list_end(vertices.size() + 1, 0);
        for (const auto& t : triangles)
            if (!collapsed(t))
                for (std::size_t k = 0; k < 3; ++k) ++list_end[ends(t, k).first + 1];
        std::partial_sum(list_end.begin(), list_end.end(), list_end.begin());
        const auto list_begin = list_end;
        std::vector<std::uint32_t> other_end(list_end.back());
        for (const auto& t : triangles)
            if (!collapsed(t))
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto edge = ends(t, k);
                    other_end[list_end[edge.first]++] = edge.second;
                }
        // A hub of a hundred thousand edges must not cost their square: long lists are sorted. The six or so of a
        // scan's vertex are counted faster than they are put in order.
        constexpr std::uint32_t short_list = 16;
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (list_end[v] - list_begin[v] > short_list)
                std::sort(other_end.data() + list_begin[v], other_end.data() + list_end[v]);
        const auto single = [&](const std::pair<std::uint32_t, std::uint32_t>& edge) {
            const auto* begin = other_end.data() + list_begin[edge.first];
            const auto* end = other_end.data() + list_end[edge.first];
            if (end - begin <= short_list) return std::count(begin, end, edge.second) == 1;
            const auto [low, high] = std::equal_range(begin, end, edge.second);
            return high - low == 1;
        };
        std::vector<std::uint8_t> marked(vertices.size(), 0);
        border_edges.assign(triangles.size(), 0);
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto edge = ends(triangles[t], k);
                if (!single(edge)) continue;
                border_edges[t] |= static_cast<std::uint8_t>(1U << k);
                marked[edge.first] = marked[edge.second] = 1;
            }
        border_vertices.assign(vertices.size(), 0);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (welded[v] != not_welded) border_vertices[v] = marked[welded[v]];
    }

    static void check_query(const Point& query, std::size_t index) {
        if (!(query.cwiseAbs().maxCoeff() <= max_coordinate_mm) || !query.allFinite())
            throw InputError(
                fmt::format("query point {} is ({}, {}, {}); closest points need finite coordinates below 1e9 "
                            "mm: leave out points without a measurement",
                            index, query.x(), query.y(), query.z()));
    }
};

SurfaceIndex::SurfaceIndex(std::span<const Point> vertices_mm, std::span<const Triangle> triangles)
    : impl_(std::make_unique<Impl>(vertices_mm, triangles)) {}
SurfaceIndex::~SurfaceIndex() = default;
SurfaceIndex::SurfaceIndex(SurfaceIndex&&) noexcept = default;
SurfaceIndex& SurfaceIndex::operator=(SurfaceIndex&&) noexcept = default;

SurfacePoint SurfaceIndex::closest(const Point& query_mm) const {
    SearchEffort effort;
    return closest(query_mm, effort);
}

SurfacePoint SurfaceIndex::closest(const Point& query_mm, SearchEffort& effort) const {
    Impl::check_query(query_mm, 0);
    return impl_->answer(impl_->nearest(query_mm, none, effort));
}

std::vector<SurfacePoint> SurfaceIndex::closest(std::span<const Point> queries_mm) const {
    return closest(queries_mm, {});
}

std::vector<SurfacePoint> SurfaceIndex::closest(std::span<const Point> queries_mm,
                                                std::span<const std::uint32_t> near_triangles) const {
    if (!near_triangles.empty() && near_triangles.size() != queries_mm.size())
        throw InputError(fmt::format("{} for {} query points; give one for each",
                                     base::counted(near_triangles.size(), "near triangle"), queries_mm.size()));
    std::vector<SurfacePoint> answers(queries_mm.size());
    base::parallel_for(queries_mm.size(), 1024, [&](std::size_t begin, std::size_t end) {
        SearchEffort effort;
        std::uint32_t start = none;  // without a better guess, the last query's triangle
        for (std::size_t i = begin; i < end; ++i) {
            const Point& query = queries_mm[i];
            Impl::check_query(query, i);
            if (!near_triangles.empty()) start = near_triangles[i];
            if (start != none && start >= impl_->triangles.size())
                throw InputError(fmt::format("query point {} is said to lie near triangle {}, but there are only {}", i,
                                             start, impl_->triangles.size()));
            const Nearest best = impl_->nearest(query, start, effort);
            answers[i] = impl_->answer(best);
            start = best.triangle;
        }
    });
    return answers;
}

bool SurfaceIndex::on_border(const SurfacePoint& point) const {
    std::call_once(impl_->border_once, [this] { impl_->mark_borders(); });
    constexpr double on_edge = 1e-9;
    const auto& corners = impl_->triangles[point.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
        const auto at = [&](std::size_t corner) { return point.barycentric[static_cast<Eigen::Index>(corner % 3)]; };
        if (at(k) >= 1.0 - on_edge) return impl_->border_vertices[corners[k]] != 0;
        if (at(k + 2) <= on_edge && (impl_->border_edges[point.triangle] >> k & 1U) != 0) return true;
    }
    return false;
}

bool SurfaceIndex::first_hit(const Point& origin_mm, const Vector& direction, SurfacePoint& hit) const {
    const double length = direction.norm();
    Impl::check_query(origin_mm, 0);
    if (!std::isfinite(length) || length == 0.0)
        throw InputError(fmt::format("ray direction ({}, {}, {}) has no finite length above 0; give another",
                                     direction.x(), direction.y(), direction.z()));
    const Vector unit = direction / length;
    Eigen::Index kz = 0;
    unit.cwiseAbs().maxCoeff(&kz);
    const Eigen::Index kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    const double shear_x = unit[kx] / unit[kz], shear_y = unit[ky] / unit[kz];

    const Point origin = origin_mm - impl_->centre;
    const Vector inverse = unit.cwiseInverse();
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t best_triangle = none;
    Eigen::Vector3d best_weights = Eigen::Vector3d::Zero();
    const auto test = [&](std::uint32_t triangle) {
        const auto& t = impl_->triangles[triangle];
        std::array<double, 3> x{}, y{}, z{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector p = impl_->vertices[t[k]] - origin_mm;
            x[k] = p[kx] - shear_x * p[kz];
            y[k] = p[ky] - shear_y * p[kz];
            z[k] = p[kz] / unit[kz];
        }
        const double u = x[2] * y[1] - y[2] * x[1], v = x[0] * y[2] - y[0] * x[2], w = x[1] * y[0] - y[1] * x[0];
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return;
        const double sum = u + v + w;
        if (sum == 0.0) return;
        const double distance = (u * z[0] + v * z[1] + w * z[2]) / sum;
        if (!(distance >= 0.0) || distance > best) return;
        if (distance == best && triangle > best_triangle) return;
        best = distance;
        best_triangle = triangle;
        best_weights = Eigen::Vector3d(u, v, w) / sum;
    };

    std::vector<std::uint32_t> stack = {0};
    while (!stack.empty()) {
        const BoxNode& node = impl_->nodes[stack.back()];
        stack.pop_back();
        for (std::size_t k = 0; k < width; ++k) {
            double enter = 0.0, leave = best;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<Eigen::Index>(axis);
                const double low = node.low[axis][k], high = node.high[axis][k];
                if (unit[i] == 0.0) {
                    if (origin[i] < low || origin[i] > high) enter = std::numeric_limits<double>::infinity();
                    continue;
                }
                const double p = (low - origin[i]) * inverse[i], q = (high - origin[i]) * inverse[i];
                enter = std::max(enter, std::min(p, q));
                leave = std::min(leave, std::max(p, q));
            }
            // The slack covers the rounding of the slab distances; boxes of unused children are never entered.
            if (enter > leave + 1e-12 * std::abs(leave) || node.low[0][k] > node.high[0][k]) continue;
            if (node.leaf)
                test(node.child[k]);
            else
                stack.push_back(node.child[k]);
        }
    }
    if (best_triangle == none) return false;
    hit.triangle = best_triangle;
    hit.barycentric = best_weights;
    hit.distance_mm = best;
    hit.position_mm = origin_mm + best * unit;
    return true;
}

std::span<const Triangle> SurfaceIndex::triangles() const { return impl_->triangles; }
std::span<const Point> SurfaceIndex::vertices_mm() const { return impl_->vertices; }

}  // namespace mimik::geometry
