#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/scored_target.h"
#include "geometry/face_surface.h"
#include "geometry/point_index.h"
#include "geometry/surface_index.h"

namespace mimik::evaluation {

/// Where the skin of some vertices went.
struct SkinPlaces {
    std::vector<geometry::Point> place_mm;
    geometry::VertexMask known;  ///< 0: nobody can say
};

/// Per vertex of the neutral face, by the region's name: 1 in the region.
using RegionMasks = std::map<std::string, geometry::VertexMask>;

/// One target under one alignment, as the estimators of the pipeline look at it: which vertices they ask, and what the
/// real face is like there. What takes time is made when somebody first asks. One thread at a time.
class EstimatedTarget {
public:
    /// References are kept. @param regions  those in which errors are wanted
    EstimatedTarget(const ScoredTarget& scored, const geometry::FaceSurface& neutral, RegionMasks regions);

    /// Parallel to vertices(): where the same skin truly went, and where a registration says that it went.
    std::optional<SkinPlaces> true_places, registered_places;

    [[nodiscard]] const ScoredTarget& scored() const { return scored_; }
    [[nodiscard]] const geometry::FaceSurface& neutral() const { return neutral_; }
    [[nodiscard]] const RegionMasks& regions() const { return regions_; }
    /// The vertices that are asked: scored, and in one region or more. The same for every method.
    [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }
    /// Area about each vertex of the neutral face, a third of each of its triangles, mm^2.
    [[nodiscard]] std::span<const double> areas_mm2() const { return areas_mm2_; }
    /// Of the neutral face's measured vertices in a region.
    [[nodiscard]] double weight_of(const std::string& region, bool by_area) const;

    [[nodiscard]] const geometry::SurfaceIndex& real() const { return *scored_.expressive; }
    /// Smooth outward normal of the real surface.
    [[nodiscard]] geometry::Vector real_normal(const geometry::SurfacePoint& at) const;
    /// Mean curvature there, between those of the triangle's corners; empty where one has none.
    [[nodiscard]] std::optional<double> real_curvature_per_m(const geometry::SurfacePoint& at);
    /// The vertices that the real surface uses.
    [[nodiscard]] const geometry::PointIndex& real_vertices();
    [[nodiscard]] std::span<const geometry::Point> real_vertices_mm();

    /// The real scan's vertices when they ask: in one region or more, by the neutral face's nearest point, and that
    /// not on its border. The same for every method.
    struct Reverse {
        std::vector<geometry::Point> places_mm;
        std::vector<double> areas_mm2;
        RegionMasks regions;                                                ///< per place
        std::map<std::string, std::pair<double, double>> weight_of_region;  ///< vertices and mm^2, border included
    };
    [[nodiscard]] const Reverse& reverse();

private:
    const ScoredTarget& scored_;
    const geometry::FaceSurface& neutral_;
    RegionMasks regions_;
    std::vector<std::uint32_t> vertices_;
    std::vector<double> areas_mm2_;
    std::vector<geometry::Vector> real_normals_;
    std::vector<std::optional<std::optional<double>>> real_curvatures_;  // per vertex; outer: not asked yet
    std::vector<geometry::Point> used_mm_;
    std::vector<std::uint32_t> used_;
    std::optional<geometry::PointIndex> used_index_;
    std::optional<Reverse> reverse_;
};

}  // namespace mimik::evaluation
