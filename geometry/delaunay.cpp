#include "geometry/delaunay.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::geometry {
namespace {

using Planar = Eigen::Vector2d;
using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;

Exact::Point_2 exact(const Planar& p) { return {p.x(), p.y()}; }

/// Signs in floating point where the error bounds A of Shewchuk (1997, "Adaptive precision floating-point arithmetic
/// and fast robust geometric predicates") leave no doubt, in exact arithmetic otherwise. The bounds hold without
/// underflow: a product may lose 2^-1075, times the other factors, which is less than the constants for coordinates
/// below 1e60.
class Predicates {
public:
    explicit Predicates(std::span<const Planar> points) {
        for (const auto& p : points)
            if (p.cwiseAbs().maxCoeff() > 1e60) orientation_floor_ = circle_floor_ = std::numeric_limits<double>::max();
    }

    /// +1 if c lies to the left of a -> b, -1 to the right, 0 on the line.
    [[nodiscard]] int orientation(const Planar& a, const Planar& b, const Planar& c) const {
        const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
        const double bound = 3.3306690738754716e-16 * (std::abs(left) + std::abs(right)) + orientation_floor_;
        if (left - right > bound) return 1;
        if (right - left > bound) return -1;
        return static_cast<int>(CGAL::orientation(exact(a), exact(b), exact(c)));
    }

    /// Whether p lies inside the circle through a, b, c, which run counter-clockwise.
    [[nodiscard]] bool in_circle(const Planar& a, const Planar& b, const Planar& c, const Planar& p) const {
        const Planar u = a - p, v = b - p, w = c - p;
        const double vw = v.x() * w.y(), wv = w.x() * v.y(), wu = w.x() * u.y(), uw = u.x() * w.y(), uv = u.x() * v.y(),
                     vu = v.x() * u.y();
        const double uu = u.squaredNorm(), vv = v.squaredNorm(), ww = w.squaredNorm();
        const double determinant = uu * (vw - wv) + vv * (wu - uw) + ww * (uv - vu);
        const double bound =
            1.1102230246251577e-15 * (uu * (std::abs(vw) + std::abs(wv)) + vv * (std::abs(wu) + std::abs(uw)) +
                                      ww * (std::abs(uv) + std::abs(vu))) +
            circle_floor_;
        if (determinant > bound) return true;
        if (-determinant > bound) return false;
        return CGAL::side_of_oriented_circle(exact(a), exact(b), exact(c), exact(p)) == CGAL::ON_POSITIVE_SIDE;
    }

private:
    double orientation_floor_ = 1e-300, circle_floor_ = 1e-170;
};

/// Where a cell of a 2^bits x 2^bits raster lies along Hilbert's curve.
std::uint32_t along_hilbert(std::uint32_t x, std::uint32_t y, int bits) {
    std::uint32_t distance = 0;
    for (int bit = bits - 1; bit >= 0; --bit) {
        const std::uint32_t right = (x >> bit) & 1U, up = (y >> bit) & 1U;
        distance = distance * 4 + ((3 * right) ^ up);
        if (up == 0) {
            if (right == 1) {
                x = ~x;
                y = ~y;
            }
            std::swap(x, y);
        }
    }
    return distance;
}

/// The order of insertion: the next point is near the last one, in rounds that double (Amenta, Choi and Rote 2003,
/// "Incremental constructions con BRIO"). Along Hilbert's curve through a raster that spans what most of the points
/// span; where it leaves many in one cell - clusters, strays - CGAL's spatial sort, which goes by medians, takes twice
/// as long and is not deceived.
std::vector<std::uint32_t> insertion_order(std::span<const Planar> points) {
    constexpr std::uint32_t crowd = 64;
    const auto count = static_cast<std::uint32_t>(points.size());
    Planar low, span;  // halved: no difference of finite numbers overflows then
    for (int axis = 0; axis < 2; ++axis) {
        std::vector<double> sample;
        const std::uint32_t stride = count / 1000 + 1;
        for (std::uint32_t i = 0; i < count; i += stride) sample.push_back(points[i][axis] / 2);
        std::sort(sample.begin(), sample.end());
        const std::size_t rest = sample.size() / 50;
        low[axis] = sample[rest];
        span[axis] = sample[sample.size() - 1 - rest] - low[axis];
    }
    const int bits = std::clamp((static_cast<int>(std::bit_width(count)) - 2) / 2, 1, 11);
    const double cells = static_cast<double>(1U << static_cast<unsigned>(bits));
    constexpr int rounds = 10;
    const auto cell = [&](const Planar& p, int axis) {
        const double where = (p[axis] / 2 - low[axis]) / span[axis] * cells;
        return where > 0 ? static_cast<std::uint32_t>(std::min(where, cells - 1)) : 0U;  // not a number: no span
    };
    std::vector<std::uint64_t> keyed(count);
    std::vector<std::uint32_t> in_cell(std::size_t{1} << static_cast<unsigned>(2 * bits), 0);
    std::uint32_t most = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        // Multiples of the golden ratio spread evenly: half of them start with bit 1, a quarter with 01, and so on.
        const std::uint32_t spread = (i + 1) * 0x9E3779B9U;
        const auto round = static_cast<std::uint64_t>(rounds - std::min(rounds, std::countl_zero(spread)));
        const std::uint64_t place = along_hilbert(cell(points[i], 0), cell(points[i], 1), bits);
        most = std::max(most, ++in_cell[place]);
        keyed[i] = round << 54U | place << 32U | i;
    }
    std::vector<std::uint32_t> order(count);
    if (most > crowd) {
        using Placed = std::pair<Exact::Point_2, std::uint32_t>;
        std::vector<Placed> placed;
        placed.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) placed.emplace_back(exact(points[i]), i);
        using Traits = CGAL::Spatial_sort_traits_adapter_2<Exact, CGAL::First_of_pair_property_map<Placed>>;
        CGAL::spatial_sort(placed.begin(), placed.end(), Traits());
        std::transform(placed.begin(), placed.end(), order.begin(), [](const Placed& one) { return one.second; });
        return order;
    }
    std::sort(keyed.begin(), keyed.end());
    for (std::uint32_t i = 0; i < count; ++i) order[i] = static_cast<std::uint32_t>(keyed[i]);
    return order;
}

constexpr std::uint32_t beyond = std::numeric_limits<std::uint32_t>::max();

/// Incremental: a point's triangle is found by walking, split in three, and edges are flipped until no circle holds the
/// point (Lawson 1977). Every edge of the hull has a triangle outside it whose third corner is `beyond`, so that points
/// outside are no special case. Corner c = 3 t + k starts the edge to the next corner of t; twin[c] starts the same
/// edge on the other side.
class Incremental {
public:
    Incremental(std::span<const Planar> points, const Predicates& predicates)
        : points_(points), predicates_(predicates) {
        vertex_.reserve(6 * points.size());
        twin_.reserve(6 * points.size());
    }

    /// The first triangle, counter-clockwise, and the three outside it.
    void begin(const Triangle& first) {
        const auto [a, b, c] = first;
        vertex_ = {a, b, c, b, a, beyond, c, b, beyond, a, c, beyond};
        twin_ = {3, 6, 9, 0, 11, 7, 1, 5, 10, 2, 8, 4};
    }

    /// @return the vertex that holds the position already, or the new one's own.
    std::uint32_t insert(std::uint32_t p) {
        const std::uint32_t t = locate(points_[p]);
        if (!outside(t))
            for (std::uint32_t k = 0; k < 3; ++k)
                if (points_[vertex_[corner(t, k)]] == points_[p]) return vertex_[corner(t, k)];
        split(t, p);
        while (!unsettled_.empty()) {
            const std::uint32_t next = unsettled_.back();
            unsettled_.pop_back();
            if (conflicts(twin_[corner(next, 0)] / 3, points_[p])) flip(next);
        }
        // Round the new point to a triangle that is none of those outside.
        for (last_ = t; outside(last_);) last_ = twin_[corner(last_, 1)] / 3;
        return p;
    }

    [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return vertex_; }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }

private:
    static std::uint32_t corner(std::uint32_t t, std::uint32_t k) { return 3 * t + k; }

    [[nodiscard]] bool outside(std::uint32_t t) const {
        return vertex_[corner(t, 0)] == beyond || vertex_[corner(t, 1)] == beyond || vertex_[corner(t, 2)] == beyond;
    }

    /// From the last triangle over the edges that have p on their far side; ends in any Delaunay triangulation.
    [[nodiscard]] std::uint32_t locate(const Planar& p) {
        const auto behind = [&](std::uint32_t edge) {
            return predicates_.orientation(points_[vertex_[edge]], points_[vertex_[next(edge)]], p) < 0;
        };
        std::uint32_t edge = corner(last_, 0);
        if (!behind(edge)) edge = twin_[edge];
        for (;;) {
            ++steps_;
            const std::uint32_t crossed = twin_[edge];
            if (outside(crossed / 3)) return crossed / 3;
            // Which side is tried first changes: always the same one would walk all round a vertex of thin triangles.
            turns_ = turns_ * 1664525U + 1013904223U;
            const std::uint32_t one = next(crossed), other = next(one);
            const bool turn = (turns_ >> 31U) != 0;
            edge = turn ? one : other;
            if (behind(edge)) continue;
            edge = turn ? other : one;
            if (!behind(edge)) return crossed / 3;
        }
    }

    void split(std::uint32_t t, std::uint32_t p) {
        const auto u = static_cast<std::uint32_t>(vertex_.size() / 3), v = u + 1;
        const std::array<std::uint32_t, 3> vertices = {vertex_[corner(t, 0)], vertex_[corner(t, 1)],
                                                       vertex_[corner(t, 2)]};
        const std::array<std::uint32_t, 3> across = {twin_[corner(t, 0)], twin_[corner(t, 1)], twin_[corner(t, 2)]};
        vertex_.resize(vertex_.size() + 6);
        twin_.resize(twin_.size() + 6);
        const std::array<std::uint32_t, 3> part = {t, u, v};
        for (std::uint32_t k = 0; k < 3; ++k) {
            set(part[k], {vertices[k], vertices[(k + 1) % 3], p});
            join(corner(part[k], 0), across[k]);
            join(corner(part[k], 1), corner(part[(k + 1) % 3], 2));
            unsettled_.push_back(part[k]);
        }
    }

    /// The triangle's first edge lies across from its last corner, p; after the flip the two end in p again.
    void flip(std::uint32_t t) {
        ++steps_;
        const std::uint32_t far = twin_[corner(t, 0)], u = far / 3, p = vertex_[corner(t, 2)];
        const std::uint32_t a = vertex_[corner(t, 0)], b = vertex_[corner(t, 1)], d = vertex_[next(next(far))];
        const std::uint32_t ad = twin_[next(far)], db = twin_[next(next(far))], bp = twin_[corner(t, 1)];
        set(t, {a, d, p});
        set(u, {d, b, p});
        join(corner(t, 0), ad);
        join(corner(u, 0), db);
        join(corner(u, 1), bp);
        join(corner(t, 1), corner(u, 2));
        unsettled_.push_back(u);
        unsettled_.push_back(t);
    }

    [[nodiscard]] bool conflicts(std::uint32_t t, const Planar& p) const {
        const std::array<std::uint32_t, 3> v = {vertex_[corner(t, 0)], vertex_[corner(t, 1)], vertex_[corner(t, 2)]};
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (v[k] != beyond) continue;
            const Planar &a = points_[v[(k + 1) % 3]], &b = points_[v[(k + 2) % 3]];
            const int side = predicates_.orientation(a, b, p);
            return side > 0 || (side == 0 && strictly_between(a, b, p));
        }
        return predicates_.in_circle(points_[v[0]], points_[v[1]], points_[v[2]], p);
    }

    /// p on the line through a and b.
    static bool strictly_between(const Planar& a, const Planar& b, const Planar& p) {
        const int axis = a.x() == b.x() ? 1 : 0;
        return (a[axis] < p[axis] && p[axis] < b[axis]) || (b[axis] < p[axis] && p[axis] < a[axis]);
    }

    static std::uint32_t next(std::uint32_t edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }

    void set(std::uint32_t t, const std::array<std::uint32_t, 3>& corners) {
        std::copy(corners.begin(), corners.end(), vertex_.begin() + 3 * static_cast<std::ptrdiff_t>(t));
    }

    void join(std::uint32_t edge, std::uint32_t other) {
        twin_[edge] = other;
        twin_[other] = edge;
    }

    std::span<const Planar> points_;
    const Predicates& predicates_;
    std::vector<std::uint32_t> vertex_, twin_, unsettled_;
    std::uint32_t last_ = 0, turns_ = 0;
    std::uint64_t steps_ = 0;
};

/// The first point, the next in another place and the next off their line, counter-clockwise; none without three such.
std::optional<Triangle> first_triangle(std::span<const Planar> points, const Predicates& predicates) {
    const auto next = [&](std::size_t from, const auto& wanted) {
        while (from < points.size() && !wanted(points[from])) ++from;
        return from;
    };
    const std::size_t second = next(1, [&](const Planar& p) { return p != points[0]; });
    const std::size_t third =
        next(second + 1, [&](const Planar& p) { return predicates.orientation(points[0], points[second], p) != 0; });
    if (third >= points.size()) return std::nullopt;
    Triangle found = {0, static_cast<std::uint32_t>(second), static_cast<std::uint32_t>(third)};
    if (predicates.orientation(points[0], points[second], points[third]) < 0) std::swap(found[1], found[2]);
    return found;
}

}  // namespace

bool spans_triangle(std::span<const Planar> points_mm) {
    return first_triangle(points_mm, Predicates(points_mm)).has_value();
}

std::vector<Triangle> delaunay(std::span<const Planar> points_mm, DelaunayReport* report) {
    for (std::size_t i = 0; i < points_mm.size(); ++i)
        if (!points_mm[i].allFinite())
            throw InputError(
                fmt::format("point {} of the triangulation is ({}, {}); leave out points that are not finite", i,
                            points_mm[i].x(), points_mm[i].y()));
    const Predicates predicates(points_mm);
    auto order = points_mm.empty() ? std::vector<std::uint32_t>{} : insertion_order(points_mm);
    std::vector<Planar> sorted;
    sorted.reserve(order.size());
    for (const auto i : order) sorted.push_back(points_mm[i]);

    const auto first = first_triangle(sorted, predicates);
    if (!first)
        throw NumericalError(fmt::format("{} on one line or in one place; a triangulation needs three that do not",
                                         base::counted(points_mm.size(), "point lies", "points lie")));

    Incremental triangulation(sorted, predicates);
    triangulation.begin(*first);
    for (std::uint32_t p = 0; p < sorted.size(); ++p) {
        if (std::find(first->begin(), first->end(), p) != first->end()) continue;
        const std::uint32_t holder = triangulation.insert(p);
        order[holder] = std::min(order[holder], order[p]);
    }
    if (report) report->steps = triangulation.steps();
    std::vector<Triangle> triangles;
    const auto& corners = triangulation.corners();
    triangles.reserve(corners.size() / 3);
    for (std::size_t t = 0; t < corners.size(); t += 3)
        if (corners[t] != beyond && corners[t + 1] != beyond && corners[t + 2] != beyond)
            triangles.push_back({order[corners[t]], order[corners[t + 1]], order[corners[t + 2]]});
    return triangles;
}

}  // namespace mimik::geometry
