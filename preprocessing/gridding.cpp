#include "preprocessing/gridding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "geometry/delaunay.h"
#include "geometry/disjoint_sets.h"
#include "geometry/polygon_triangles.h"
#include "geometry/statistics.h"
#include "geometry/topology.h"

namespace mimik::preprocessing {
namespace {

using geometry::Point;
using geometry::QuadGrid;
using geometry::RangeScan;
using geometry::TextureCoordinate;
using geometry::Triangle;
using geometry::VertexOrigin;
using Planar = Eigen::Vector2d;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A grid vertex this close to an edge counts as on it: far above rounding (1e-14 mm), far below measuring.
constexpr double on_edge_mm = 1e-10;

/// What interpolation reads: valid points only, or all points of a lattice.
struct Samples {
    std::span<const Point> points_mm;
    std::span<const TextureCoordinate> texture;  // empty, or one per point
};

double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double planar_squared(const Point& a, const Point& b) {
    const double dx = b.x() - a.x(), dy = b.y() - a.y();
    return dx * dx + dy * dy;
}

double longest_squared(const Samples& samples, const Triangle& t) {
    const auto& p = samples.points_mm;
    return std::max(
        {planar_squared(p[t[0]], p[t[1]]), planar_squared(p[t[1]], p[t[2]]), planar_squared(p[t[2]], p[t[0]])});
}

/// MATLAB's linspace: both ends exact.
std::vector<double> linspace(double low, double high, int count) {
    std::vector<double> values(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) values[static_cast<std::size_t>(i)] = low + i * ((high - low) / (count - 1));
    values.back() = high;
    return values;
}

/// Draws triangles into a grid: each vertex that a triangle covers gets the triangle's height there.
class Raster {
public:
    Raster(QuadGrid& grid, std::vector<double> x, std::vector<double> y)
        : grid_(grid), x_(std::move(x)), y_(std::move(y)), open_(y_.size(), x_.size()) {
        per_x_ = (grid.cols - 1) / (x_.back() - x_.front());
        per_y_ = (grid.rows - 1) / (y_.back() - y_.front());
    }

    /// A counter-clockwise triangle. Covered vertices that are still open take it; others only if `front` and it is
    /// nearer to the camera.
    void draw(const Samples& samples, const Triangle& t, VertexOrigin origin, bool front) {
        const Point &a = samples.points_mm[t[0]], &b = samples.points_mm[t[1]], &c = samples.points_mm[t[2]];
        const auto [first_row, last_row] =
            range(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), y_, per_y_);
        if (first_row > last_row) return;
        const auto [first_col, last_col] =
            range(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), x_, per_x_);
        if (first_col > last_col) return;
        const double area2 = cross(a, b, c);
        if (!(area2 > 0.0)) return;
        // Squared slack: e is (distance to the edge) x (length of the edge).
        const double slack_a = -on_edge_mm * std::sqrt(planar_squared(b, c));
        const double slack_b = -on_edge_mm * std::sqrt(planar_squared(c, a));
        const double slack_c = -on_edge_mm * std::sqrt(planar_squared(a, b));
        for (int row = first_row; row <= last_row; ++row) {
            if (!front && open_[static_cast<std::size_t>(row)] == 0) continue;
            int from = first_col, to = last_col;
            if (to - from > 8) narrow(row, {a, b, c}, from, to);
            for (int col = from; col <= to; ++col) {
                const auto vertex = grid_.index(row, col);
                const bool open = grid_.origin[vertex] == VertexOrigin::outside;
                if (!open && !front) continue;
                const Point g(x_[static_cast<std::size_t>(col)], y_[static_cast<std::size_t>(row)], 0.0);
                double u = cross(b, c, g), v = cross(c, a, g), w = cross(a, b, g);
                if (u < slack_a || v < slack_b || w < slack_c) continue;
                u = std::max(u, 0.0);
                v = std::max(v, 0.0);
                w = std::max(w, 0.0);
                const double sum = u + v + w;
                u /= sum;
                v /= sum;
                w /= sum;
                const double z = u * a.z() + v * b.z() + w * c.z();
                if (!open && z <= grid_.vertices_mm[vertex].z()) continue;
                grid_.vertices_mm[vertex].z() = z;
                grid_.origin[vertex] = origin;
                if (!samples.texture.empty())
                    grid_.texture_coordinates[vertex] =
                        u * samples.texture[t[0]] + v * samples.texture[t[1]] + w * samples.texture[t[2]];
                if (open) --open_[static_cast<std::size_t>(row)];
            }
        }
    }

    /// Takes back what was drawn at a vertex.
    void open(std::uint32_t vertex) {
        grid_.vertices_mm[vertex].z() = nan;
        grid_.origin[vertex] = VertexOrigin::outside;
        if (!grid_.texture_coordinates.empty()) grid_.texture_coordinates[vertex] = {nan, nan};
        ++open_[vertex / static_cast<std::uint32_t>(grid_.cols)];
    }

private:
    // Grid lines within [low, high], widened by the slack.
    static std::array<int, 2> range(double low, double high, const std::vector<double>& lines, double per_mm) {
        const double first = std::ceil((low - lines.front() - 2 * on_edge_mm) * per_mm - 1e-9);
        const double last = std::floor((high - lines.front() + 2 * on_edge_mm) * per_mm + 1e-9);
        return {static_cast<int>(std::max(first, 0.0)),
                static_cast<int>(std::min(last, static_cast<double>(lines.size() - 1)))};
    }

    // The columns of a wide triangle on one row, a column to spare on both sides.
    void narrow(int row, const std::array<Point, 3>& corners, int& from, int& to) const {
        const double y = y_[static_cast<std::size_t>(row)];
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point &p = corners[k], &q = corners[(k + 1) % 3];
            if (std::min(p.y(), q.y()) > y + on_edge_mm || std::max(p.y(), q.y()) < y - on_edge_mm) continue;
            const double dy = q.y() - p.y();
            if (std::abs(dy) <= 2 * on_edge_mm) {
                low = std::min({low, p.x(), q.x()});
                high = std::max({high, p.x(), q.x()});
                continue;
            }
            const double x = p.x() + std::clamp((y - p.y()) / dy, 0.0, 1.0) * (q.x() - p.x());
            low = std::min(low, x);
            high = std::max(high, x);
        }
        if (low > high) {
            to = from - 1;
            return;
        }
        from = std::max(from, static_cast<int>((low - x_.front()) * per_x_) - 1);
        to = std::min(to, static_cast<int>((high - x_.front()) * per_x_) + 2);
    }

    QuadGrid& grid_;
    std::vector<double> x_, y_;
    std::vector<std::size_t> open_;  // vertices per row that nothing covers yet
    double per_x_ = 0.0, per_y_ = 0.0;
};

// Medians of some thousands of values taken at even steps: the whole scan is as good and costs more than the rest.
double lattice_spacing(const RangeScan& scan, const std::vector<std::uint8_t>& valid) {
    const std::size_t step = std::max<std::size_t>(1, scan.points_mm.size() / 5003);
    const auto cols = static_cast<std::size_t>(scan.cols);
    std::vector<double> squared;
    for (std::size_t i = 0; i < scan.points_mm.size(); i += step) {
        if (!valid[i]) continue;
        if ((i + 1) % cols != 0 && valid[i + 1])
            squared.push_back(planar_squared(scan.points_mm[i], scan.points_mm[i + 1]));
        if (i + cols < valid.size() && valid[i + cols])
            squared.push_back(planar_squared(scan.points_mm[i], scan.points_mm[i + cols]));
    }
    return std::sqrt(geometry::upper_median(std::move(squared)));
}

double triangle_spacing(const Samples& samples, const std::vector<Triangle>& triangles) {
    const std::size_t step = std::max<std::size_t>(1, triangles.size() / 5003);
    std::vector<double> squared;
    for (std::size_t t = 0; t < triangles.size(); t += step)
        for (std::size_t k = 0; k < 3; ++k)
            squared.push_back(
                planar_squared(samples.points_mm[triangles[t][k]], samples.points_mm[triangles[t][(k + 1) % 3]]));
    return std::sqrt(geometry::upper_median(std::move(squared)));
}

/// > 0 where d lies inside the circle through a, b, c (counter-clockwise), relative to the size of the terms.
double in_circle(const Point& a, const Point& b, const Point& c, const Point& d) {
    const double ax = a.x() - d.x(), ay = a.y() - d.y(), bx = b.x() - d.x(), by = b.y() - d.y(), cx = c.x() - d.x(),
                 cy = c.y() - d.y();
    const double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    const double value = aa * (bx * cy - by * cx) - bb * (ax * cy - ay * cx) + cc * (ax * by - ay * bx);
    const double scale = std::max({aa, bb, cc});
    return value / (scale * scale);
}

/// The cells of the lattice, split and facing the camera, and the points on the rims of what they cover.
struct Lattice {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> rim;
    std::size_t folded = 0;
};

Lattice split_cells(const RangeScan& scan, const std::vector<std::uint8_t>& valid, double max_edge_mm) {
    const auto cols = static_cast<std::uint32_t>(scan.cols), rows = static_cast<std::uint32_t>(scan.rows);
    const auto& p = scan.points_mm;
    const double max_squared = max_edge_mm * max_edge_mm;

    // Rows may run up or down and columns left or right: most cells say which way round the lattice is.
    std::int64_t turning = 0;
    for (std::uint32_t r = 0; r + 1 < rows; ++r)
        for (std::uint32_t c = 0; c + 1 < cols; c += 3) {
            const auto i = r * cols + c;
            if (valid[i] && valid[i + 1] && valid[i + cols])
                turning += cross(p[i], p[i + 1], p[i + cols]) > 0.0 ? 1 : -1;
        }
    const bool mirrored = turning < 0;

    Lattice lattice;
    lattice.triangles.reserve(2 * p.size());
    std::vector<std::uint8_t> full_cells(p.size(), 0);  // around each point
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (!valid[a] || !valid[b] || !valid[c]) return false;
        if (mirrored) std::swap(b, c);
        // Seen from behind, or so edge-on that its height is not a function of x and y.
        if (!(cross(p[a], p[b], p[c]) > 1e-12)) {
            ++lattice.folded;
            return false;
        }
        if (std::max({planar_squared(p[a], p[b]), planar_squared(p[b], p[c]), planar_squared(p[c], p[a])}) >
            max_squared)
            return false;
        lattice.triangles.push_back({a, b, c});
        return true;
    };
    for (std::uint32_t r = 0; r + 1 < rows; ++r)
        for (std::uint32_t c = 0; c + 1 < cols; ++c) {
            const std::uint32_t a = r * cols + c, b = a + 1, d = a + cols, e = d + 1;  // d e above a b
            const int corners = valid[a] + valid[b] + valid[d] + valid[e];
            if (corners < 3) continue;
            if (corners == 3) {
                if (!valid[a]) add(b, e, d);
                if (!valid[b]) add(a, e, d);
                if (!valid[d]) add(a, b, e);
                if (!valid[e]) add(a, b, d);
                continue;
            }
            // Ties, the rule on an exact lattice, leave the first diagonal; 1e-9 is above their rounding.
            const double inside = mirrored ? in_circle(p[a], p[e], p[b], p[d]) : in_circle(p[a], p[b], p[e], p[d]);
            const bool first = inside <= 1e-9;
            const bool lower = first ? add(a, b, e) : add(a, b, d);
            const bool upper = first ? add(a, e, d) : add(b, e, d);
            if (lower && upper)
                for (const auto v : {a, b, d, e}) ++full_cells[v];
        }
    for (std::uint32_t v = 0; v < p.size(); ++v)
        if (valid[v] && full_cells[v] < 4) lattice.rim.push_back(v);
    return lattice;
}

/// The faces of a mesh as triangles that face the camera, and the rims of what they cover.
struct FacingMesh {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> rim;
};

FacingMesh facing_triangles(const RangeScan& scan, const std::vector<std::uint8_t>& valid) {
    const auto& p = scan.points_mm;
    FacingMesh mesh;
    auto triangles = geometry::triangulate(scan.faces, p);
    std::erase_if(triangles, [&](const Triangle& t) { return !valid[t[0]] || !valid[t[1]] || !valid[t[2]]; });
    for (auto t : triangles) {
        const double area2 = cross(p[t[0]], p[t[1]], p[t[2]]);
        if (!(std::abs(area2) > 1e-12)) continue;  // edge-on: no height over x and y
        if (area2 < 0) std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
    }
    std::vector<std::uint8_t> at_rim(p.size(), 0);
    for (const auto& [a, b] : geometry::border_edges(triangles)) at_rim[a] = at_rim[b] = 1;
    for (std::uint32_t v = 0; v < p.size(); ++v)
        if (at_rim[v]) mesh.rim.push_back(v);
    return mesh;
}

/// Of `rim`, the points that no part of the drawn surface hides and that do not lie in a pit.
std::vector<std::uint32_t> in_sight(const std::vector<std::uint32_t>& rim, std::span<const Point> points_mm,
                                    const QuadGrid& grid, const std::vector<std::uint8_t>& pit) {
    constexpr double in_front_mm = 5.0;  // more than a steep cheek rises from one grid line to the next
    const Point low = grid.vertices_mm.front(), high = grid.vertices_mm.back();
    std::vector<std::uint32_t> seen;
    for (const auto v : rim) {
        const Point& p = points_mm[v];
        const auto row = std::lround((p.y() - low.y()) / (high.y() - low.y()) * (grid.rows - 1));
        const auto col = std::lround((p.x() - low.x()) / (high.x() - low.x()) * (grid.cols - 1));
        const auto cell = grid.index(static_cast<int>(row), static_cast<int>(col));
        if (pit[cell]) continue;  // the vertices beside the pit stand for its edge
        if (!grid.inside(cell) || grid.vertices_mm[cell].z() < p.z() + in_front_mm) seen.push_back(v);
    }
    return seen;
}

constexpr double steepest = 6.0;  // rise over run: scanners lose surfaces that rise by more than about 5

bool is_drop(const Point& p, const Point& q) {
    return std::abs(p.z() - q.z()) > steepest * std::sqrt(planar_squared(p, q));
}

/// Calls visit(a, b) for the vertices at both ends of every edge of the grid.
template <class Visit>
void for_each_edge(const QuadGrid& grid, const Visit& visit) {
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            if (col + 1 < grid.cols) visit(grid.index(row, col), grid.index(row, col + 1));
            if (row + 1 < grid.rows) visit(grid.index(row, col), grid.index(row + 1, col));
        }
}

// Deeper than eyeballs lie behind lids and teeth behind lips; the inside of a head is ten times as far.
constexpr double deep_mm = 10.0;

/// Patches of a grid: vertices joined by edges that are no deep drops.
geometry::DisjointSets patches_of(const QuadGrid& grid) {
    geometry::DisjointSets patches(grid.size());
    for_each_edge(grid, [&](std::uint32_t a, std::uint32_t b) {
        const Point &p = grid.vertices_mm[a], &q = grid.vertices_mm[b];
        if (grid.inside(a) && grid.inside(b) && !(is_drop(p, q) && std::abs(p.z() - q.z()) > deep_mm))
            patches.join(a, b);
    });
    return patches;
}

/// Which patches are spared from being pits.
class SparedPatches {
public:
    explicit SparedPatches(std::size_t vertices) : pit_(vertices, 1) {}
    void spare(std::uint32_t patch) {
        if (pit_[patch] == 0) return;
        pit_[patch] = 0;
        spared_.push_back(patch);
    }
    /// Spares what lies in front of a spared patch, and so on. @param behind_and_nearer  pairs of patches, sorted
    void spare_in_front(const std::vector<std::array<std::uint32_t, 2>>& behind_and_nearer) {
        while (!spared_.empty()) {
            const auto patch = spared_.back();
            spared_.pop_back();
            for (auto pair =
                     std::lower_bound(behind_and_nearer.begin(), behind_and_nearer.end(), std::array{patch, 0U});
                 pair != behind_and_nearer.end() && (*pair)[0] == patch; ++pair)
                spare((*pair)[1]);
        }
    }
    [[nodiscard]] bool is_pit(std::uint32_t patch) const { return pit_[patch] != 0; }

private:
    std::vector<std::uint8_t> pit_;  // per patch, which its lowest vertex stands for
    std::vector<std::uint32_t> spared_;
};

/// Spares the large patches and those at the border of the grid.
void spare_large_and_outer(const QuadGrid& grid, geometry::DisjointSets& patches, SparedPatches& result) {
    constexpr std::uint32_t large = 10;  // a patch of a tenth of the largest is a face in a hood, not an eye in a face
    std::vector<std::uint32_t> size(grid.size(), 0);
    for (std::uint32_t v = 0; v < grid.size(); ++v)
        if (grid.inside(v)) ++size[patches.root(v)];
    const std::uint32_t largest = *std::max_element(size.begin(), size.end());
    for (std::uint32_t v = 0; v < grid.size(); ++v)
        if (large * std::uint64_t{size[v]} >= largest) result.spare(v);
    for (int row = 0; row < grid.rows; ++row)
        for (const int col : {0, grid.cols - 1}) result.spare(patches.root(grid.index(row, col)));
    for (int col = 0; col < grid.cols; ++col)
        for (const int row : {0, grid.rows - 1}) result.spare(patches.root(grid.index(row, col)));
}

/// The vertices of pits: small patches of drawn surface that deep drops set apart on all sides, behind what surrounds
/// them, as the inside of the head is where a mesh has openings for eyes and mouth.
std::vector<std::uint8_t> in_pits(const QuadGrid& grid) {
    auto patches = patches_of(grid);
    // No pit is what is large, what lies at the border or beside nothing, and what lies in front of what is no pit: a
    // pit may have a deeper one in it.
    SparedPatches spared(grid.size());
    spare_large_and_outer(grid, patches, spared);
    std::vector<std::array<std::uint32_t, 2>> behind_and_nearer;
    for_each_edge(grid, [&](std::uint32_t a, std::uint32_t b) {
        const auto one = patches.root(a), other = patches.root(b);
        if (one == other) return;
        if (!grid.inside(a)) return spared.spare(other);
        if (!grid.inside(b)) return spared.spare(one);
        const bool a_nearer = grid.vertices_mm[a].z() > grid.vertices_mm[b].z();
        behind_and_nearer.push_back({a_nearer ? other : one, a_nearer ? one : other});
    });
    std::sort(behind_and_nearer.begin(), behind_and_nearer.end());
    spared.spare_in_front(behind_and_nearer);
    std::vector<std::uint8_t> result(grid.size(), 0);
    for (std::uint32_t v = 0; v < grid.size(); ++v)
        result[v] = grid.inside(v) && spared.is_pit(patches.root(v)) ? 1 : 0;
    return result;
}

/// The drawn vertices next to a pit.
std::vector<std::uint32_t> beside(const QuadGrid& grid, const std::vector<std::uint8_t>& pit) {
    std::vector<std::uint8_t> next(grid.size(), 0);
    for_each_edge(grid, [&](std::uint32_t a, std::uint32_t b) {
        if (pit[a] != pit[b]) next[pit[a] ? b : a] = 1;
    });
    std::vector<std::uint32_t> result;
    for (std::uint32_t v = 0; v < grid.size(); ++v)
        if (next[v]) result.push_back(v);
    return result;
}

/// Where the surface drops out of sight (from the jaw to the neck, from an ear to the head) the farther vertex no
/// longer counts as measured: what lies between the two was not seen.
void cut_at_drops(QuadGrid& grid) {
    std::vector<std::uint32_t> beyond;
    for_each_edge(grid, [&](std::uint32_t a, std::uint32_t b) {
        if (!grid.measured(a) || !grid.measured(b)) return;
        const Point &p = grid.vertices_mm[a], &q = grid.vertices_mm[b];
        if (is_drop(p, q)) beyond.push_back(p.z() < q.z() ? a : b);
    });
    for (const auto v : beyond) grid.origin[v] = VertexOrigin::bridged;
}

/// Whether the corners of a triangle lie so far behind one another that it joins front and back.
bool joins_front_and_back(const Samples& samples, const Triangle& t, double planar_squared_mm) {
    constexpr double behind_mm = 20.0;
    const auto& p = samples.points_mm;
    const auto [low, high] = std::minmax({p[t[0]].z(), p[t[1]].z(), p[t[2]].z()});
    return high - low > std::max(behind_mm, steepest * std::sqrt(planar_squared_mm));
}

/// The valid points, and where several share x and y their mean at the lowest of them: the one that delaunay() names.
struct Merged {
    std::vector<Point> points_mm;
    std::vector<TextureCoordinate> texture;
    std::size_t duplicates = 0;
};

Merged gather(const RangeScan& scan, const std::vector<std::uint8_t>& valid, std::size_t count) {
    Merged merged;
    merged.points_mm.reserve(count);
    for (std::size_t i = 0; i < valid.size(); ++i) {
        if (!valid[i]) continue;
        merged.points_mm.push_back(scan.points_mm[i]);
        if (!scan.texture_coordinates.empty()) merged.texture.push_back(scan.texture_coordinates[i]);
    }
    return merged;
}

void average_duplicates(Merged& merged) {
    const auto& p = merged.points_mm;
    std::vector<std::uint32_t> order(p.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (p[a].x() != p[b].x()) return p[a].x() < p[b].x();
        return p[a].y() != p[b].y() ? p[a].y() < p[b].y() : a < b;
    });
    for (std::size_t i = 0, end = 0; i < order.size(); i = end) {
        double z = 0.0;
        TextureCoordinate texture = TextureCoordinate::Zero();
        for (end = i; end < order.size() && p[order[end]].head<2>() == p[order[i]].head<2>(); ++end) {
            z += p[order[end]].z();
            if (!merged.texture.empty()) texture += merged.texture[order[end]];
        }
        const auto shared = static_cast<double>(end - i);
        merged.points_mm[order[i]].z() = z / shared;
        if (!merged.texture.empty()) merged.texture[order[i]] = texture / shared;
        merged.duplicates += end - i - 1;
    }
}

/// How many of the points are corners: every distinct one is.
std::size_t corners_of(const std::vector<Triangle>& triangles, std::size_t points) {
    std::vector<std::uint8_t> used(points, 0);
    for (const auto& t : triangles)
        for (const auto v : t) used[v] = 1;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), std::uint8_t{1}));
}

std::vector<Planar> planar(std::span<const Point> points_mm) {
    std::vector<Planar> result;
    result.reserve(points_mm.size());
    for (const auto& p : points_mm) result.emplace_back(p.x(), p.y());
    return result;
}

void check_sizes(const RangeScan& scan) {
    const auto& p = scan.points_mm;
    if (!scan.texture_coordinates.empty() && scan.texture_coordinates.size() != p.size())
        throw InputError(fmt::format("the scan has {}{} texture coordinates; give one per point or none",
                                     base::counted(p.size(), "point"), scan.texture_coordinates.size()));
    if (scan.organised() && static_cast<std::size_t>(scan.rows) * static_cast<std::size_t>(scan.cols) != p.size())
        throw InputError(
            fmt::format("the scan has {} points but a lattice of {} x {}", p.size(), scan.rows, scan.cols));
}

/// What of a scan was measured, and where it lies in x-y.
struct Extent {
    std::vector<std::uint8_t> valid;  // per point
    std::size_t points = 0;
    Planar low = Planar::Constant(std::numeric_limits<double>::infinity()), high = -low;
};

Extent extent_of(const RangeScan& scan) {
    const auto& p = scan.points_mm;
    Extent extent;
    extent.valid.resize(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) {
        extent.valid[i] = p[i].allFinite() ? 1 : 0;
        if (!extent.valid[i]) continue;
        ++extent.points;
        extent.low = extent.low.cwiseMin(p[i].head<2>());
        extent.high = extent.high.cwiseMax(p[i].head<2>());
    }
    if (extent.points < 3)
        throw InputError(
            fmt::format("the scan has {}; a surface needs three or more", base::counted(extent.points, "valid point")));
    if (!((extent.high - extent.low).minCoeff() > 0.0))
        throw NumericalError(fmt::format(
            "all {} points of the scan lie on one line in x-y; turn the face to the camera", extent.points));
    return extent;
}

QuadGrid empty_grid(const std::vector<double>& x, const std::vector<double>& y, bool textured) {
    QuadGrid grid;
    grid.rows = static_cast<int>(y.size());
    grid.cols = static_cast<int>(x.size());
    grid.vertices_mm.reserve(x.size() * y.size());
    for (const double row_y : y)
        for (const double col_x : x) grid.vertices_mm.emplace_back(col_x, row_y, nan);
    grid.origin.assign(grid.vertices_mm.size(), VertexOrigin::outside);
    if (textured) grid.texture_coordinates.assign(grid.vertices_mm.size(), {nan, nan});
    return grid;
}

/// Measured ones first: a vertex on an edge between the two kinds is measured.
/// @return share of the triangles between close points that join front and back
double draw_all(Raster& raster, const Samples& samples, const std::vector<Triangle>& triangles, double max_edge_mm) {
    std::vector<std::uint32_t> bridges;
    std::size_t joining = 0;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const double squared = longest_squared(samples, triangles[t]);
        const bool close = squared <= max_edge_mm * max_edge_mm;
        const bool joins = close && joins_front_and_back(samples, triangles[t], squared);
        joining += joins ? 1 : 0;
        if (!close || joins)
            bridges.push_back(t);
        else
            raster.draw(samples, triangles[t], VertexOrigin::measured, false);
    }
    for (const auto t : bridges) raster.draw(samples, triangles[t], VertexOrigin::bridged, false);
    const std::size_t close = triangles.size() - bridges.size() + joining;
    return close == 0 ? 0.0 : static_cast<double>(joining) / static_cast<double>(close);
}

void fill_between(Raster& raster, const Merged& rim, double max_edge_mm) {
    const auto across = planar(rim.points_mm);
    if (!geometry::spans_triangle(across)) return;  // a closed surface, or slits in one
    draw_all(raster, {rim.points_mm, rim.texture}, geometry::delaunay(across), max_edge_mm);
}

/// One scan on its way into a grid, in one of three ways.
class Gridding {
public:
    Gridding(const RangeScan& scan, const GriddingOptions& options)
        : scan_(scan),
          options_(options),
          extent_(extent_of(scan)),
          x_(linspace(extent_.low.x(), extent_.high.x(), options.cols)),
          y_(linspace(extent_.low.y(), extent_.high.y(), options.rows)),
          grid_(empty_grid(x_, y_, !scan.texture_coordinates.empty())),
          raster_(grid_, x_, y_) {
        report_.points = extent_.points;
    }

    void by_lattice() {
        report_.method = GriddingMethod::lattice;
        const double max_edge_mm = longest_edge_mm(lattice_spacing(scan_, extent_.valid));
        const auto lattice = split_cells(scan_, extent_.valid, max_edge_mm);
        report_.folded_triangles = lattice.folded;
        report_.rim_points = lattice.rim.size();
        draw_surface(lattice.triangles);
        fill_between(raster_, points_of(lattice.rim), max_edge_mm);
    }

    void by_mesh() {
        report_.method = GriddingMethod::mesh;
        const auto mesh = facing_triangles(scan_, extent_.valid);
        draw_surface(mesh.triangles);
        const auto pit = in_pits(grid_);
        auto rim = points_of(in_sight(mesh.rim, scan_.points_mm, grid_, pit));
        report_.rim_points = rim.points_mm.size();
        // A pit is bridged from its edge, where the mesh need not have a border.
        for (const auto v : beside(grid_, pit)) {
            rim.points_mm.push_back(grid_.vertices_mm[v]);
            if (!grid_.texture_coordinates.empty()) rim.texture.push_back(grid_.texture_coordinates[v]);
        }
        for (std::uint32_t v = 0; v < grid_.size(); ++v)
            if (pit[v]) raster_.open(v);
        report_.pit_vertices = static_cast<std::size_t>(std::count(pit.begin(), pit.end(), std::uint8_t{1}));
        cut_at_drops(grid_);
        report_.spacing_mm = triangle_spacing(all_points(), mesh.triangles);
        report_.max_edge_mm = 0.0;  // what no face covers was not measured, however short the way across
        fill_between(raster_, rim, report_.max_edge_mm);
    }

    void by_triangulation() {
        auto merged = gather(scan_, extent_.valid, extent_.points);
        const auto all = geometry::delaunay(planar(merged.points_mm));
        if (corners_of(all, merged.points_mm.size()) < merged.points_mm.size()) average_duplicates(merged);
        report_.duplicates = merged.duplicates;
        const Samples samples{merged.points_mm, merged.texture};
        report_.seen_through = draw_all(raster_, samples, all, longest_edge_mm(triangle_spacing(samples, all)));
    }

    [[nodiscard]] GriddingReport report() const {
        auto report = report_;
        for (const auto origin : grid_.origin) {
            report.measured += origin == VertexOrigin::measured ? 1 : 0;
            report.bridged += origin == VertexOrigin::bridged ? 1 : 0;
            report.outside += origin == VertexOrigin::outside ? 1 : 0;
        }
        return report;
    }
    [[nodiscard]] QuadGrid take_grid() { return std::move(grid_); }

private:
    [[nodiscard]] Samples all_points() const { return {scan_.points_mm, scan_.texture_coordinates}; }
    double longest_edge_mm(double spacing_mm) {
        report_.spacing_mm = spacing_mm;
        report_.max_edge_mm = options_.max_edge_mm.value_or(options_.max_edge_spacings * spacing_mm);
        return report_.max_edge_mm;
    }
    void draw_surface(const std::vector<Triangle>& triangles) {
        for (const auto& t : triangles) raster_.draw(all_points(), t, VertexOrigin::measured, true);
    }
    [[nodiscard]] Merged points_of(const std::vector<std::uint32_t>& rim) const {
        Merged some;
        for (const auto v : rim) {
            some.points_mm.push_back(scan_.points_mm[v]);
            if (!scan_.texture_coordinates.empty()) some.texture.push_back(scan_.texture_coordinates[v]);
        }
        return some;
    }

    const RangeScan& scan_;
    const GriddingOptions& options_;
    const Extent extent_;
    const std::vector<double> x_, y_;  // of the grid's columns and rows
    QuadGrid grid_;
    Raster raster_;  // draws into grid_
    GriddingReport report_;
};

}  // namespace

void GriddingOptions::check() const {
    if (rows < 2 || cols < 2 || rows > 20000 || cols > 20000)
        throw InputError(fmt::format("grid of {} x {}: rows and cols must lie between 2 and 20000", rows, cols));
    if (max_edge_mm && !(*max_edge_mm > 0.0))
        throw InputError(
            fmt::format("max_edge_mm is {}; give a length above 0, or none to use the scan's spacing", *max_edge_mm));
    if (!(max_edge_spacings > 0.0))
        throw InputError(fmt::format("max_edge_spacings is {}; give a number above 0", max_edge_spacings));
}

QuadGrid grid_scan(const RangeScan& scan, const GriddingOptions& options, GriddingReport* report) {
    options.check();
    check_sizes(scan);
    Gridding gridding(scan, options);
    if (options.use_lattice && scan.organised())
        gridding.by_lattice();
    else if (options.use_lattice && scan.faces.size() > 0)
        gridding.by_mesh();
    else
        gridding.by_triangulation();
    if (report) *report = gridding.report();
    return gridding.take_grid();
}

}  // namespace mimik::preprocessing
