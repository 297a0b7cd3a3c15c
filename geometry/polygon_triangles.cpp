#include "geometry/polygon_triangles.h"

#include <algorithm>
#include <cmath>

namespace mimik::geometry {
namespace {

/// Twice the area of the triangle, as a vector. Differences first: coordinates may be far from the origin.
Vector doubled_area(const Point& a, const Point& b, const Point& c) { return (b - a).cross(c - a); }

template <class At>
Vector mean_normal(std::size_t corners, At at) {
    Vector sum = Vector::Zero();
    for (std::size_t k = 2; k < corners; ++k) sum += doubled_area(at(0), at(k - 1), at(k));
    return sum;
}

template <class At>
bool is_fan(std::size_t corners, At at) {
    if (corners < 4) return true;
    const Vector normal = mean_normal(corners, at);
    const double least = -1e-9 * normal.squaredNorm();  // rounding of corners in one line
    for (std::size_t k = 2; k < corners; ++k)
        if (doubled_area(at(0), at(k - 1), at(k)).dot(normal) < least) return false;
    return true;
}

/// Cuts ears off one polygon that is laid flat.
class EarCutter {
public:
    explicit EarCutter(std::span<const Point> corners_mm) {
        const Vector up = mean_normal(corners_mm.size(), [&](std::size_t k) { return corners_mm[k]; }).normalized();
        const Vector right = up.unitOrthogonal(), ahead = up.cross(right);
        for (const auto& corner : corners_mm) {
            const Vector from_first = corner - corners_mm[0];
            flat_.emplace_back(from_first.dot(right), from_first.dot(ahead));
        }
        const auto n = flat_.size();
        for (std::size_t k = 0; k < n; ++k) {
            before_.push_back((k + n - 1) % n);
            after_.push_back((k + 1) % n);
        }
        for (std::size_t k = 0; k < n; ++k)
            if (turn(before_[k], k, after_[k]) < 0) reflex_.push_back(k);
    }

    std::vector<Triangle> cut() {
        std::vector<Triangle> triangles;
        std::size_t at = 0, passed = 0;
        for (std::size_t left = flat_.size(); left > 2;) {
            // Who crosses itself may have no ear: then a corner that is none goes, so that the cutting ends.
            const bool forced = passed >= left;
            if (!forced && !is_ear(at)) {
                at = after_[at];
                ++passed;
                continue;
            }
            const auto before = before_[at], after = after_[at];
            triangles.push_back({static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(at),
                                 static_cast<std::uint32_t>(after)});
            after_[before] = after;
            before_[after] = before;
            std::erase_if(reflex_, [&](std::size_t r) {
                return r == at || ((r == before || r == after) && turn(before_[r], r, after_[r]) >= 0);
            });
            at = after_[after];  // not the neighbour: slivers that all meet in one corner would be left
            passed = 0;
            --left;
        }
        return triangles;
    }

private:
    /// Positive where the way a, b, c turns left.
    [[nodiscard]] double turn(std::size_t a, std::size_t b, std::size_t c) const {
        const Eigen::Vector2d ab = flat_[b] - flat_[a], ac = flat_[c] - flat_[a];
        return ab.x() * ac.y() - ab.y() * ac.x();
    }
    [[nodiscard]] bool is_ear(std::size_t at) const {
        const auto before = before_[at], after = after_[at];
        if (!(turn(before, at, after) > 0)) return false;
        return std::none_of(reflex_.begin(), reflex_.end(), [&](std::size_t r) {
            if (flat_[r] == flat_[before] || flat_[r] == flat_[at] || flat_[r] == flat_[after]) return false;
            return turn(before, at, r) >= 0 && turn(at, after, r) >= 0 && turn(after, before, r) >= 0;
        });
    }

    std::vector<Eigen::Vector2d> flat_;
    std::vector<std::size_t> before_, after_;  ///< the corners that are left, in a ring
    std::vector<std::size_t> reflex_;          ///< those of them that could lie in an ear
};

}  // namespace

bool is_fan(std::span<const std::uint32_t> face, std::span<const Point> vertices_mm) {
    return is_fan(face.size(), [&](std::size_t k) -> const Point& { return vertices_mm[face[k]]; });
}

std::vector<Triangle> cut_polygon(std::span<const Point> corners_mm) {
    if (!is_fan(corners_mm.size(), [&](std::size_t k) -> const Point& { return corners_mm[k]; }) &&
        corners_mm.size() <= most_corners_cut)
        return EarCutter(corners_mm).cut();
    std::vector<Triangle> fan;
    for (std::uint32_t k = 2; k < corners_mm.size(); ++k) fan.push_back({0, k - 1, k});
    return fan;
}

std::vector<Triangle> triangulate(const Faces& faces, std::span<const Point> vertices_mm) {
    std::vector<Triangle> triangles;
    triangles.reserve(faces.corners.size() - std::min(faces.corners.size(), 2 * faces.size()));
    std::vector<Point> corners;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto face = faces[f];
        if (is_fan(face, vertices_mm)) {
            for (std::size_t k = 2; k < face.size(); ++k) triangles.push_back({face[0], face[k - 1], face[k]});
            continue;
        }
        corners.clear();
        for (const auto v : face) corners.push_back(vertices_mm[v]);
        for (const auto& t : cut_polygon(corners)) triangles.push_back({face[t[0]], face[t[1]], face[t[2]]});
    }
    return triangles;
}

}  // namespace mimik::geometry
