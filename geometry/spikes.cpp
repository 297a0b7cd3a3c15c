#include "geometry/spikes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/point_index.h"
#include "geometry/statistics.h"

namespace mimik::geometry {

namespace {

ScanNeighbours lattice_neighbours(const RangeScan& scan, int radius) {
    std::vector<char> valid(scan.points_mm.size());  // each point is asked for by 24 others
    for (std::size_t i = 0; i < valid.size(); ++i) valid[i] = static_cast<char>(scan.valid(i));
    ScanNeighbours neighbours;
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
ScanNeighbours mesh_neighbours(const RangeScan& scan, const std::vector<std::uint32_t>& first) {
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
    ScanNeighbours neighbours;
    neighbours.first.assign(first.size() + 1, 0);
    for (const auto& [from, to] : pairs) {
        ++neighbours.first[from + 1];
        neighbours.index.push_back(to);
    }
    std::partial_sum(neighbours.first.begin(), neighbours.first.end(), neighbours.first.begin());
    return neighbours;
}

ScanNeighbours cloud_neighbours(const RangeScan& scan, const std::vector<std::uint32_t>& first) {
    std::vector<Point> valid;
    std::vector<std::uint32_t> place;
    for (std::uint32_t i = 0; i < scan.points_mm.size(); ++i)
        if (scan.valid(i) && first[i] == i) {
            valid.push_back(scan.points_mm[i]);
            place.push_back(i);
        }
    if (valid.empty()) return {std::vector<std::size_t>(first.size() + 1, 0), {}, {}};
    const PointIndex index(valid);
    std::vector<double> spacing;
    for (std::size_t i = 0; i < valid.size(); i += std::max<std::size_t>(1, valid.size() / 1000)) {
        const auto two = index.nearest(valid[i], 2);
        if (two.size() == 2) spacing.push_back(two[1].distance_mm);
    }
    const double radius_mm = spacing.empty() ? 1.0 : std::max(1e-9, 3.0 * upper_median(std::move(spacing)));
    // As many as a lattice's two rings at most: a crowded place must not list everything around it.
    constexpr std::size_t most = 24;
    ScanNeighbours neighbours;
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

}  // namespace

ScanNeighbours scan_neighbours(const RangeScan& scan) {
    std::vector<std::uint32_t> first(scan.points_mm.size());
    std::iota(first.begin(), first.end(), 0U);
    if (!scan.organised()) first = first_of_place(scan);
    auto neighbours = scan.organised()        ? lattice_neighbours(scan, 2)
                      : scan.faces.size() > 0 ? mesh_neighbours(scan, first)
                                              : cloud_neighbours(scan, first);
    neighbours.first_of_place = std::move(first);
    return neighbours;
}

VertexMask find_spikes(const RangeScan& scan, const ScanNeighbours& neighbours, double spike_mm) {
    VertexMask spike(scan.points_mm.size(), 0);
    std::vector<double> depth_of(scan.points_mm.size()), depths;
    for (std::size_t i = 0; i < depth_of.size(); ++i) depth_of[i] = scan.points_mm[i].z();
    for (std::size_t i = 0; i < spike.size(); ++i) {
        const auto around = neighbours[i];
        if (around.size() < 3) continue;
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (const auto other : around) {
            lowest = std::min(lowest, depth_of[other]);
            highest = std::max(highest, depth_of[other]);
        }
        // Most points lie within the depths around them, give or take: the median is needed for the few others only.
        const double z = depth_of[i];
        if (z <= lowest + spike_mm && z >= highest - spike_mm) continue;
        double limit_mm = spike_mm;
        if (!scan.faces.corners.empty()) {
            double apart_mm = 0;
            for (const auto other : around) apart_mm += (scan.points_mm[other] - scan.points_mm[i]).head<2>().norm();
            limit_mm = std::max(limit_mm, 2.0 * apart_mm / static_cast<double>(around.size()));
        }
        depths.clear();
        std::transform(around.begin(), around.end(), std::back_inserter(depths),
                       [&](std::uint32_t other) { return depth_of[other]; });
        const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
        std::nth_element(depths.begin(), middle, depths.end());
        spike[i] = std::abs(z - *middle) > limit_mm ? 1 : 0;
    }
    return spike;
}

}  // namespace mimik::geometry
