#include "evaluation/estimated_target.h"

#include <algorithm>

#include "evaluation/surface_curvature.h"
#include "geometry/mesh.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::SurfacePoint;
using geometry::Vector;

namespace {

std::vector<double> areas_about(std::span<const Point> vertices_mm, std::span<const geometry::Triangle> triangles) {
    std::vector<double> areas(vertices_mm.size(), 0.0);
    for (const auto& t : triangles) {
        const Vector across = (vertices_mm[t[1]] - vertices_mm[t[0]]).cross(vertices_mm[t[2]] - vertices_mm[t[0]]);
        for (const auto corner : t) areas[corner] += across.norm() / 6;
    }
    return areas;
}

std::vector<geometry::Triangle> measured_triangles(const geometry::FaceSurface& face) {
    std::vector<geometry::Triangle> measured;
    for (const auto& t : face.triangles)
        if (face.measured[t[0]] && face.measured[t[1]] && face.measured[t[2]]) measured.push_back(t);
    return measured;
}

bool in_any(const RegionMasks& regions, std::uint32_t v) {
    return std::any_of(regions.begin(), regions.end(), [&](const auto& region) { return region.second[v] != 0; });
}

}  // namespace

EstimatedTarget::EstimatedTarget(const ScoredTarget& scored, const geometry::FaceSurface& neutral, RegionMasks regions)
    : scored_(scored),
      neutral_(neutral),
      regions_(std::move(regions)),
      areas_mm2_(areas_about(neutral.vertices_mm, neutral.triangles)),
      real_normals_(geometry::vertex_normals(real().vertices_mm(), real().triangles())),
      real_curvatures_(real().vertices_mm().size()) {
    for (const auto v : scored.vertices)
        if (in_any(regions_, v)) vertices_.push_back(v);
    std::vector<char> is_used(real().vertices_mm().size(), 0);
    for (const auto& t : real().triangles())
        for (const auto corner : t) is_used[corner] = 1;
    for (std::uint32_t v = 0; v < is_used.size(); ++v) {
        if (!is_used[v]) continue;
        used_.push_back(v);
        used_mm_.push_back(real().vertices_mm()[v]);
    }
}

double EstimatedTarget::weight_of(const std::string& region, bool by_area) const {
    const auto& mask = regions_.at(region);
    double weight = 0;
    for (std::size_t v = 0; v < neutral_.size(); ++v)
        if (mask[v] && neutral_.measured[v]) weight += by_area ? areas_mm2_[v] : 1.0;
    return weight;
}

Vector EstimatedTarget::real_normal(const SurfacePoint& at) const {
    const auto& corners = real().triangles()[at.triangle];
    Vector sum = Vector::Zero();
    for (std::size_t k = 0; k < 3; ++k) sum += at.barycentric[static_cast<Eigen::Index>(k)] * real_normals_[corners[k]];
    return sum.stableNormalized();
}

std::optional<double> EstimatedTarget::real_curvature_per_m(const SurfacePoint& at) {
    const auto& corners = real().triangles()[at.triangle];
    double curvature = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double share = at.barycentric[static_cast<Eigen::Index>(k)];
        if (share == 0) continue;
        auto& kept = real_curvatures_[corners[k]];
        if (!kept)
            kept = mean_curvature_per_m(used_mm_, real_vertices(), real().vertices_mm()[corners[k]],
                                        real_normals_[corners[k]]);
        if (!*kept) return std::nullopt;
        curvature += share * **kept;
    }
    return curvature;
}

const geometry::PointIndex& EstimatedTarget::real_vertices() {
    if (!used_index_) used_index_.emplace(used_mm_);
    return *used_index_;
}

std::span<const Point> EstimatedTarget::real_vertices_mm() { return used_mm_; }

const EstimatedTarget::Reverse& EstimatedTarget::reverse() {
    if (reverse_) return *reverse_;
    auto& made = reverse_.emplace();
    auto neutral_mm = neutral_.vertices_mm;
    for (std::size_t v = 0; v < neutral_mm.size(); ++v)
        if (!neutral_.measured[v]) neutral_mm[v] = Point::Zero();  // no triangle has it
    const geometry::SurfaceIndex index(neutral_mm, measured_triangles(neutral_));
    const auto areas = areas_about(real().vertices_mm(), real().triangles());
    const auto hits = index.closest(used_mm_);
    for (std::size_t k = 0; k < hits.size(); ++k) {
        Eigen::Index nearest = 0;
        hits[k].barycentric.maxCoeff(&nearest);
        const auto v = index.triangles()[hits[k].triangle][static_cast<std::size_t>(nearest)];
        if (!in_any(regions_, v)) continue;
        for (const auto& [name, mask] : regions_)
            if (mask[v]) {
                made.weight_of_region[name].first += 1;
                made.weight_of_region[name].second += areas[used_[k]];
            }
        if (index.on_border(hits[k])) continue;
        made.places_mm.push_back(used_mm_[k]);
        made.areas_mm2.push_back(areas[used_[k]]);
        for (const auto& [name, mask] : regions_) made.regions[name].push_back(mask[v]);
    }
    return made;
}

}  // namespace mimik::evaluation
