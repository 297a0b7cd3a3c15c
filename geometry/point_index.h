#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/types.h"

namespace mimik::geometry {

/// Nearest points of a cloud: build once, ask often, from any thread. Ties go to the lower index. A pile of equal
/// points is one place to a search, however many lie there.
class PointIndex {
public:
    /// @throws InputError if there is no point or one is not finite.
    explicit PointIndex(std::span<const Point> points_mm);
    ~PointIndex();
    PointIndex(PointIndex&&) noexcept;
    PointIndex& operator=(PointIndex&&) noexcept;

    struct Neighbour {
        std::size_t index = 0;
        double distance_mm = 0.0;
    };
    [[nodiscard]] Neighbour nearest(const Point& query_mm) const;
    [[nodiscard]] std::vector<Neighbour> nearest(std::span<const Point> queries_mm) const;  ///< parallel
    /// The k nearest, nearest first (fewer if the cloud is smaller).
    [[nodiscard]] std::vector<Neighbour> nearest(const Point& query_mm, std::size_t k) const;
    [[nodiscard]] std::vector<Neighbour> within(const Point& query_mm, double radius_mm) const;  ///< nearest first

    /// What a search chooses from: the points, each pile of equal ones (from nine on) once.
    [[nodiscard]] std::size_t places() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The point that lies nearest among those for which counts(index) holds; ties go to the lower index; empty: there is
/// none. Looks at every point: of few questions that costs less than building an index.
template <class Counts>
std::optional<std::size_t> nearest_point(std::span<const Point> points_mm, const Point& query_mm,
                                         const Counts& counts) {
    std::optional<std::size_t> nearest;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points_mm.size(); ++i) {
        const double squared = (points_mm[i] - query_mm).squaredNorm();
        if (!(squared < best) || !counts(i)) continue;
        best = squared;
        nearest = i;
    }
    return nearest;
}

}  // namespace mimik::geometry
