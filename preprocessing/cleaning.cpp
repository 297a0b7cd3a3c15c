#include "preprocessing/cleaning.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/point_index.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::RangeScan;

void CleaningOptions::check() const {
    if (!(spike_mm > 0)) throw InputError(fmt::format("spike_mm is {}; give more than 0", spike_mm));
    if (!(max_jump_mm > 0)) throw InputError(fmt::format("max_jump_mm is {}; give more than 0", max_jump_mm));
    if (!(min_part >= 0 && min_part <= 1))
        throw InputError(fmt::format("min_part is {}; give a share between 0 and 1", min_part));
}

namespace {

constexpr double background_depth_mm = 150.0;  // a head is about 200 mm deep, and a scanner sees its front half

/// Neighbour lists in one flat array: of point i, entries [first[i], first[i + 1]).
struct Neighbours {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> index;
};

Neighbours lattice_neighbours(const RangeScan& scan, int radius) {
    std::vector<char> valid(scan.points_mm.size());  // each point is asked for by 24 others
    for (std::size_t i = 0; i < valid.size(); ++i) valid[i] = static_cast<char>(scan.valid(i));
    Neighbours neighbours;
    neighbours.first.reserve(scan.points_mm.size() + 1);
    neighbours.index.reserve(scan.points_mm.size() * static_cast<std::size_t>(4 * radius * (radius + 1)));
    neighbours.first.push_back(0);
    for (int row = 0; row < scan.rows; ++row)
        for (int col = 0; col < scan.cols; ++col) {
            if (valid[static_cast<std::size_t>(row) * static_cast<std::size_t>(scan.cols) +
                      static_cast<std::size_t>(col)])
                for (int r = std::max(0, row - radius); r <= std::min(scan.rows - 1, row + radius); ++r)
                    for (int c = std::max(0, col - radius); c <= std::min(scan.cols - 1, col + radius); ++c) {
                        const auto other = static_cast<std::size_t>(r) * static_cast<std::size_t>(scan.cols) +
                                           static_cast<std::size_t>(c);
                        if (valid[other] && (r != row || c != col))
                            neighbours.index.push_back(static_cast<std::uint32_t>(other));
                    }
            neighbours.first.push_back(neighbours.index.size());
        }
    return neighbours;
}

/// Of points at exactly the same place (a texture's seam, or what a camera writes for nothing) the first stands for
/// all.
std::vector<std::uint32_t> first_of_place(const RangeScan& scan) {
    const auto& p = scan.points_mm;
    std::vector<std::uint32_t> order, first(p.size());
    std::iota(first.begin(), first.end(), 0U);
    for (std::uint32_t i = 0; i < p.size(); ++i)
        if (scan.valid(i)) order.push_back(i);
    const auto place = [&](std::uint32_t i) { return std::array{p[i].x(), p[i].y(), p[i].z()}; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto pa = place(a), pb = place(b);
        return pa != pb ? pa < pb : a < b;
    });
    for (std::size_t k = 1; k < order.size(); ++k)
        if (place(order[k]) == place(order[k - 1])) first[order[k]] = first[order[k - 1]];
    return first;
}

/// Along the edges of the faces, welded at seams: no spacing is assumed.
Neighbours mesh_neighbours(const RangeScan& scan, const std::vector<std::uint32_t>& first) {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (std::size_t f = 0; f < scan.faces.size(); ++f) {
        const auto face = scan.faces[f];
        for (std::size_t k = 0; k < face.size(); ++k) {
            const auto a = first[face[k]], b = first[face[(k + 1) % face.size()]];
            if (a == b || !scan.valid(a) || !scan.valid(b)) continue;
            pairs.push_back({a, b});
            pairs.push_back({b, a});
        }
    }
    for (std::uint32_t i = 0; i < first.size(); ++i)
        if (first[i] != i) pairs.push_back({i, first[i]});
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    Neighbours neighbours;
    neighbours.first.assign(first.size() + 1, 0);
    for (const auto& [from, to] : pairs) {
        ++neighbours.first[from + 1];
        neighbours.index.push_back(to);
    }
    std::partial_sum(neighbours.first.begin(), neighbours.first.end(), neighbours.first.begin());
    return neighbours;
}

Neighbours cloud_neighbours(const RangeScan& scan, const std::vector<std::uint32_t>& first) {
    std::vector<Point> valid;
    std::vector<std::uint32_t> place;
    for (std::uint32_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i) && first[i] == i) {
            valid.push_back(scan.points_mm[i]);
            place.push_back(i);
        }
    const geometry::PointIndex index(valid);
    std::vector<double> spacing;
    for (std::size_t i = 0; i < valid.size(); i += std::max<std::size_t>(1, valid.size() / 1000)) {
        const auto two = index.nearest(valid[i], 2);
        if (two.size() == 2) spacing.push_back(two[1].distance_mm);
    }
    double radius_mm = 1.0;
    if (!spacing.empty()) {
        std::nth_element(spacing.begin(), spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2),
                         spacing.end());
        radius_mm = std::max(1e-9, 3.0 * spacing[spacing.size() / 2]);
    }
    // As many as a lattice's two rings at most: a crowded place must not list everything around it.
    constexpr std::size_t most = 24;
    Neighbours neighbours;
    neighbours.first.assign(first.size() + 1, 0);
    std::size_t k = 0;
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        if (k < place.size() && place[k] == i) {
            for (const auto& n : index.nearest(valid[k], most + 1))
                if (n.index != k && n.distance_mm <= radius_mm) neighbours.index.push_back(place[n.index]);
            ++k;
        } else if (first[i] != i)
            neighbours.index.push_back(first[i]);
        neighbours.first[i + 1] = neighbours.index.size();
    }
    return neighbours;
}

/// 1 for a spike; a point with fewer than three neighbours cannot be judged and is none.
std::vector<char> find_spikes(const RangeScan& scan, const Neighbours& neighbours, double spike_mm) {
    std::vector<char> spike(scan.points_mm.size(), 0);
    std::vector<double> depth_of(scan.points_mm.size()), depths;
    for (std::size_t i = 0; i < depth_of.size(); ++i) depth_of[i] = scan.points_mm[i].z();
    for (std::size_t i = 0; i < spike.size(); ++i) {
        const auto first = neighbours.index.begin() + static_cast<std::ptrdiff_t>(neighbours.first[i]);
        const auto last = neighbours.index.begin() + static_cast<std::ptrdiff_t>(neighbours.first[i + 1]);
        if (last - first < 3) continue;
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (auto other = first; other != last; ++other) {
            lowest = std::min(lowest, depth_of[*other]);
            highest = std::max(highest, depth_of[*other]);
        }
        // Most points lie within the depths around them, give or take: the median is needed for the few others only.
        const double z = depth_of[i];
        if (z <= lowest + spike_mm && z >= highest - spike_mm) continue;
        // Where a mesh is coarse a steep surface falls by more from vertex to vertex.
        double limit_mm = spike_mm;
        if (!scan.faces.corners.empty()) {
            double apart_mm = 0;
            for (auto other = first; other != last; ++other)
                apart_mm += (scan.points_mm[*other] - scan.points_mm[i]).head<2>().norm();
            limit_mm = std::max(limit_mm, 2.0 * apart_mm / static_cast<double>(last - first));
        }
        depths.clear();
        std::transform(first, last, std::back_inserter(depths), [&](std::uint32_t other) { return depth_of[other]; });
        const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
        std::nth_element(depths.begin(), middle, depths.end());
        spike[i] = std::abs(z - *middle) > limit_mm ? 1 : 0;
    }
    return spike;
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

}  // namespace

RangeScan clean(const RangeScan& scan, const CleaningOptions& options, CleaningReport* report) {
    options.check();
    CleaningReport counts;
    const std::size_t n = scan.points_mm.size();
    for (std::size_t i = 0; i < n; ++i) counts.points += scan.valid(i) ? 1 : 0;
    if (counts.points == 0) throw InputError("the scan holds no measured point");

    const bool has_faces = !scan.organised() && scan.faces.size() > 0;
    std::vector<std::uint32_t> first(n);
    std::iota(first.begin(), first.end(), 0U);
    if (!scan.organised()) first = first_of_place(scan);
    const Neighbours neighbours = scan.organised() ? lattice_neighbours(scan, 2)
                                  : has_faces      ? mesh_neighbours(scan, first)
                                                   : cloud_neighbours(scan, first);
    std::vector<char> dropped = find_spikes(scan, neighbours, options.spike_mm);
    counts.spikes = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));

    // Parts: neighbours that lie close in space hang together.
    std::vector<std::uint32_t> parent(n);
    std::iota(parent.begin(), parent.end(), 0U);
    for (std::size_t i = 0; i < n; ++i) {
        if (dropped[i] || !scan.valid(i)) continue;
        for (std::size_t k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k) {
            const auto other = neighbours.index[k];
            // A lattice's neighbours are each other's; the nearest of a cloud need not be.
            if ((scan.organised() && other > i) || dropped[other] || parent[other] == parent[i]) continue;
            // What the faces of a mesh join hangs together, however coarse they are.
            if (!has_faces &&
                (scan.points_mm[i] - scan.points_mm[other]).squaredNorm() > options.max_jump_mm * options.max_jump_mm)
                continue;
            const auto a = root(parent, static_cast<std::uint32_t>(i)), b = root(parent, other);
            if (a != b) parent[std::max(a, b)] = std::min(a, b);
        }
    }
    std::vector<std::size_t> size(n, 0);
    std::vector<double> depth_sum(n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
        if (!dropped[i] && scan.valid(i) && first[i] == i) {  // a place counts once
            const auto part = root(parent, static_cast<std::uint32_t>(i));
            ++size[part];
            depth_sum[part] += scan.points_mm[i].z();
        }
    // The face is the part in front: among the large parts, background lies far behind.
    const std::size_t most = *std::max_element(size.begin(), size.end());
    double front_mm = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i)
        if (size[i] > 0 && static_cast<double>(size[i]) >= 0.2 * static_cast<double>(most))
            front_mm = std::max(front_mm, depth_sum[i] / static_cast<double>(size[i]));
    std::size_t face = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (size[i] > 0 && depth_sum[i] / static_cast<double>(size[i]) >= front_mm - background_depth_mm)
            face = std::max(face, size[i]);
    const auto stays = [&](std::size_t part) {
        return static_cast<double>(size[part]) >= options.min_part * static_cast<double>(face) &&
               depth_sum[part] / static_cast<double>(size[part]) >= front_mm - background_depth_mm;
    };
    for (std::size_t i = 0; i < n; ++i) {
        if (size[i] > 0 && !stays(i)) ++counts.stray_parts;
        if (dropped[i] || !scan.valid(i)) continue;
        if (!stays(root(parent, static_cast<std::uint32_t>(i)))) {
            dropped[i] = 2;
            ++counts.stray_points;
        }
    }
    counts.kept = counts.points - counts.spikes - counts.stray_points;
    if (counts.kept == 0) throw InputError("cleaning left no point; raise spike_mm or lower min_part");
    if (report) *report = counts;

    RangeScan cleaned = scan;
    const Point nothing = Point::Constant(std::numeric_limits<double>::quiet_NaN());
    if (scan.organised()) {
        for (std::size_t i = 0; i < n; ++i)
            if (dropped[i]) cleaned.points_mm[i] = nothing;
        return cleaned;
    }
    cleaned.points_mm.clear();
    cleaned.texture_coordinates.clear();
    cleaned.faces = {};
    std::vector<std::uint32_t> place(n, std::numeric_limits<std::uint32_t>::max());
    for (std::size_t i = 0; i < n; ++i)
        if (!dropped[i] && scan.valid(i)) {
            place[i] = static_cast<std::uint32_t>(cleaned.points_mm.size());
            cleaned.points_mm.push_back(scan.points_mm[i]);
            if (!scan.texture_coordinates.empty()) cleaned.texture_coordinates.push_back(scan.texture_coordinates[i]);
        }
    for (std::size_t f = 0; f < scan.faces.size(); ++f) {
        std::vector<std::uint32_t> face_corners;
        for (const auto v : scan.faces[f]) face_corners.push_back(place[v]);
        if (std::find(face_corners.begin(), face_corners.end(), std::numeric_limits<std::uint32_t>::max()) ==
            face_corners.end())
            cleaned.faces.add(face_corners);
    }
    return cleaned;
}

}  // namespace mimik::preprocessing
