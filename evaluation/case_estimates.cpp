#include "evaluation/case_estimates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluation/surface_curvature.h"
#include "geometry/mesh.h"

namespace mimik::evaluation {

using geometry::Point;
using geometry::SurfacePoint;
using geometry::Vector;

namespace {

constexpr double reach_mm = 10.0;  // along a normal: beyond it another part of the face is met

double angle_deg(const Vector& a, const Vector& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

}  // namespace

CaseEstimates::CaseEstimates(EstimatedTarget& target, const JudgedFace& face)
    : target_(target), face_(face), curvatures_(target.vertices().size()) {
    const auto& neutral = target.neutral();
    moved_mm_.reserve(neutral.size());
    for (std::uint32_t v = 0; v < neutral.size(); ++v)
        moved_mm_.emplace_back(neutral.present[v] ? Point(neutral.vertices_mm[v] + face.way_mm(v))
                                                  : Point(Point::Zero()));
    for (const auto v : target.vertices()) asked_mm_.push_back(moved_mm_[v]);
}

const std::vector<Vector>& CaseEstimates::normals() {
    if (!normals_) normals_ = geometry::vertex_normals(moved_mm_, target_.neutral().triangles);
    return *normals_;
}

std::vector<std::optional<CaseEstimates::Partner>> CaseEstimates::closest_partners() const {
    std::vector<std::optional<Partner>> found;
    for (const auto& hit : target_.real().closest(asked_mm_)) found.emplace_back(Partner{hit.position_mm, hit});
    return found;
}

std::vector<std::optional<CaseEstimates::Partner>> CaseEstimates::partners_along_normals() {
    const auto& normal = normals();
    std::vector<std::optional<Partner>> found(asked_mm_.size());
    for (std::size_t k = 0; k < asked_mm_.size(); ++k) {
        const Vector& out = normal[target_.vertices()[k]];
        if (!(out.squaredNorm() > 0.5)) continue;
        double nearest_mm = reach_mm;
        for (const double side : {1.0, -1.0}) {
            SurfacePoint hit;
            if (!target_.real().first_hit(asked_mm_[k], side * out, hit)) continue;
            const double mm = (hit.position_mm - asked_mm_[k]).norm();
            if (mm > nearest_mm) continue;
            nearest_mm = mm;
            found[k] = Partner{hit.position_mm, hit};
        }
    }
    return found;
}

std::vector<std::optional<CaseEstimates::Partner>> CaseEstimates::partners_at(
    const std::optional<SkinPlaces>& places) const {
    std::vector<std::optional<Partner>> found(asked_mm_.size());
    if (!places) return found;
    std::vector<std::size_t> known;
    std::vector<Point> queries;
    for (std::size_t k = 0; k < found.size(); ++k)
        if (places->known[k]) {
            known.push_back(k);
            queries.push_back(places->place_mm[k]);
        }
    const auto hits = target_.real().closest(queries);
    for (std::size_t i = 0; i < known.size(); ++i) found[known[i]] = Partner{queries[i], hits[i]};
    return found;
}

const std::vector<std::optional<CaseEstimates::Partner>>& CaseEstimates::partners(Correspondence correspondence) {
    auto& kept = partners_.at(static_cast<std::size_t>(correspondence));
    if (kept) return *kept;
    switch (correspondence) {
        case Correspondence::closest_point:
            return kept.emplace(closest_partners());
        case Correspondence::along_normal:
            return kept.emplace(partners_along_normals());
        case Correspondence::registered:
            return kept.emplace(partners_at(target_.registered_places));
        case Correspondence::truth:
            break;
    }
    return kept.emplace(partners_at(target_.true_places));
}

std::optional<double> CaseEstimates::curvature_per_m(std::size_t k) {
    auto& kept = curvatures_[k];
    if (kept) return *kept;
    if (!present_index_) {
        for (std::size_t v = 0; v < moved_mm_.size(); ++v)
            if (target_.neutral().measured[v]) present_mm_.push_back(moved_mm_[v]);
        present_index_.emplace(present_mm_);
    }
    kept = mean_curvature_per_m(present_mm_, *present_index_, asked_mm_[k], normals()[target_.vertices()[k]]);
    return *kept;
}

std::vector<std::optional<double>> CaseEstimates::errors(Correspondence correspondence, Distance distance) {
    std::vector<std::optional<double>> errors(asked_mm_.size());
    const auto& found = partners(correspondence);
    const bool to_vertex = correspondence == Correspondence::closest_point && distance == Distance::point_to_point;
    const auto vertices =
        to_vertex ? target_.real_vertices().nearest(asked_mm_) : std::vector<geometry::PointIndex::Neighbour>();
    for (std::size_t k = 0; k < errors.size(); ++k) {
        if (!found[k]) continue;
        const auto& [place_mm, on_real] = *found[k];
        if (to_vertex)
            errors[k] = vertices[k].distance_mm;
        else if (distance == Distance::along_normal)
            errors[k] = (asked_mm_[k] - place_mm).dot(target_.real_normal(on_real));
        else if (distance == Distance::normal_angle)
            errors[k] = angle_deg(normals()[target_.vertices()[k]], target_.real_normal(on_real));
        else if (distance == Distance::curvature) {
            const auto own = curvature_per_m(k), real = target_.real_curvature_per_m(on_real);
            if (own && real) errors[k] = std::abs(*own - *real);
        } else
            errors[k] = correspondence == Correspondence::closest_point ? on_real.distance_mm
                                                                        : (asked_mm_[k] - place_mm).norm();
    }
    return errors;
}

const std::vector<double>& CaseEstimates::reverse_errors_mm() {
    if (reverse_mm_) return *reverse_mm_;
    const auto& neutral = target_.neutral();
    std::vector<geometry::Triangle> measured;
    for (const auto& t : neutral.triangles)
        if (neutral.measured[t[0]] && neutral.measured[t[1]] && neutral.measured[t[2]]) measured.push_back(t);
    reverse_mm_.emplace();
    for (const auto& hit : geometry::SurfaceIndex(moved_mm_, measured).closest(target_.reverse().places_mm))
        reverse_mm_->push_back(hit.distance_mm);
    return *reverse_mm_;
}

std::vector<RegionErrors> CaseEstimates::by_region(const std::vector<std::optional<double>>& errors,
                                                   bool by_area) const {
    std::vector<RegionErrors> all;
    for (const auto& [name, mask] : target_.regions()) {
        auto& region = all.emplace_back();
        region.weight_of_region = target_.weight_of(name, by_area);
        for (std::size_t k = 0; k < errors.size(); ++k) {
            const auto v = target_.vertices()[k];
            if (!mask[v] || !errors[k]) continue;
            region.errors.push_back(*errors[k]);
            region.weights.push_back(by_area ? target_.areas_mm2()[v] : 1.0);
        }
    }
    return all;
}

std::vector<RegionErrors> CaseEstimates::reverse_by_region(bool by_area) {
    const auto& errors = reverse_errors_mm();
    const auto& asked = target_.reverse();
    std::vector<RegionErrors> all;
    for (const auto& [name, unused] : target_.regions()) {
        auto& region = all.emplace_back();
        const auto mask = asked.regions.find(name);
        if (mask == asked.regions.end()) continue;
        const auto weight = asked.weight_of_region.at(name);
        region.weight_of_region = by_area ? weight.second : weight.first;
        for (std::size_t k = 0; k < errors.size(); ++k) {
            if (!mask->second[k]) continue;
            region.errors.push_back(errors[k]);
            region.weights.push_back(by_area ? asked.areas_mm2[k] : 1.0);
        }
    }
    return all;
}

std::vector<Measure> CaseEstimates::hausdorff(const MetricOptions& options) {
    const auto there = by_region(errors(Correspondence::closest_point, Distance::point_to_surface), false);
    const auto back = reverse_by_region(false);
    std::vector<Measure> measures;
    std::size_t r = 0;
    for (const auto& [name, mask] : target_.regions()) {
        const auto &forth = there[r], &reverse = back[r];
        ++r;
        if (forth.errors.empty() || reverse.errors.empty()) continue;
        const auto largest = [](const RegionErrors& side, double q) {
            return weighted_quantile(side.errors, side.weights, q);
        };
        measures.push_back({name, "max", std::max(largest(forth, 1), largest(reverse, 1)), "mm"});
        const auto& asked = options.metrics;
        if (std::find(asked.begin(), asked.end(), "p95") != asked.end())
            measures.push_back({name, "p95", std::max(largest(forth, 0.95), largest(reverse, 0.95)), "mm"});
    }
    return measures;
}

std::vector<Measure> CaseEstimates::measure(const EstimatorChoice& choice, const MetricOptions& options) {
    if (choice.direction == Direction::larger_of_both) return hausdorff(options);
    if (choice.correspondence == Correspondence::truth && !target_.true_places) return {};
    if (choice.correspondence == Correspondence::registered && !target_.registered_places) return {};
    const auto& definition = definition_of(choice);
    const auto found = choice.direction == Direction::to_synthetic
                           ? reverse_by_region(options.area_weighted)
                           : by_region(errors(choice.correspondence, choice.distance), options.area_weighted);
    std::vector<Measure> measures;
    std::size_t r = 0;
    for (const auto& [name, mask] : target_.regions()) {
        auto figures = figures_of(found[r++], name, definition.unit, options, definition.metric);
        measures.insert(measures.end(), figures.begin(), figures.end());
    }
    return measures;
}

}  // namespace mimik::evaluation
