#include "animation/marker_animator.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "geometry/surface_index.h"

namespace mimik::animation {

using geometry::Point;
using geometry::Vector;

namespace {

constexpr std::array<MarkerMethod, 7> all_methods = {
    MarkerMethod::still, MarkerMethod::nearest, MarkerMethod::rbf,        MarkerMethod::open_bones,
    MarkerMethod::bones, MarkerMethod::units,   MarkerMethod::units_bones};

bool has_bones(MarkerMethod method) {
    return method == MarkerMethod::open_bones || method == MarkerMethod::bones || method == MarkerMethod::units_bones;
}
bool has_units(MarkerMethod method) { return method == MarkerMethod::units || method == MarkerMethod::units_bones; }

}  // namespace

const char* to_string(MarkerMethod method) {
    switch (method) {
        case MarkerMethod::still:
            return "still";
        case MarkerMethod::nearest:
            return "nearest";
        case MarkerMethod::rbf:
            return "rbf";
        case MarkerMethod::open_bones:
            return "open-bones";
        case MarkerMethod::bones:
            return "bones";
        case MarkerMethod::units:
            return "units";
        case MarkerMethod::units_bones:
            return "units-bones";
    }
    return "still";
}

std::span<const MarkerMethod> marker_methods() { return all_methods; }

MarkerMethod parse_marker_method(const std::string& name) {
    std::vector<std::string> names;
    for (const auto method : all_methods) {
        if (name == to_string(method)) return method;
        names.emplace_back(to_string(method));
    }
    throw InputError(fmt::format("there is no method '{}'; there are: {}", name, fmt::join(names, ", ")));
}

MarkerAnimator::MarkerAnimator(MarkerMethod method, const Mesh& mesh, const capture::MarkerSet& set,
                               const geometry::Landmarks& labels, std::vector<std::string> tracked,
                               const MarkerAnimatorOptions& options)
    : method_(method),
      options_(options),
      set_(set),
      labels_(labels),
      tracked_(std::move(tracked)),
      vertices_mm_(mesh.vertices_mm.begin(), mesh.vertices_mm.end()) {
    for (const auto& name : tracked_) {
        const auto* label = labels.find(name);
        if (!label) throw InputError(fmt::format("the marker '{}' has no label on the mesh", name));
        rest_mm_.push_back(label->position_mm);
    }
    if (rest_mm_.empty()) throw InputError("no marker of the recording is labelled on the mesh");
    if (method_ == MarkerMethod::nearest) {
        nearest_.resize(vertices_mm_.size());
        for (std::size_t v = 0; v < vertices_mm_.size(); ++v) {
            std::size_t best = 0;
            for (std::size_t k = 1; k < rest_mm_.size(); ++k)
                if ((rest_mm_[k] - vertices_mm_[v]).squaredNorm() < (rest_mm_[best] - vertices_mm_[v]).squaredNorm())
                    best = k;
            nearest_[v] = static_cast<std::uint32_t>(best);
        }
    }
    if (has_units(method_)) bind_units(mesh, options.units);
    if (has_bones(method_)) bind_bones(mesh, set, labels, options.bones);
}

void MarkerAnimator::bind_bones(const Mesh& mesh, const capture::MarkerSet& set, const geometry::Landmarks& labels,
                                const PlanarBonesOptions& options) {
    auto names = tracked_;
    // Points without markers, where what they hang on is tracked.
    const capture::MarkerSequence once(tracked_, 1, 1);
    for (const auto& name : capture::derive_markers(once, labels, set).derived) names.push_back(name);
    surface_ = capture::control_surface(set, names);
    std::vector<Point> corners;
    for (const auto& name : names) corners.push_back(labels.position_mm(name));
    BoneMasks masks;
    if (method_ != MarkerMethod::open_bones && !mesh.parts.empty()) {
        masks.of_bone = surface_.parts;
        masks.of_vertex.assign(mesh.parts.begin(), mesh.parts.end());
    }
    bones_ = PlanarBones(corners, surface_.triangles, vertices_mm_, options, masks);
}

void MarkerAnimator::bind_units(const Mesh& mesh, const UnitWeightsOptions& options) {
    if (!mesh.units || mesh.units->fields_mm.empty())
        throw InputError(
            fmt::format("the method {} needs Action Units on the mesh, and there are none", to_string(method_)));
    unit_fields_ = mesh.units->fields_mm;
    const geometry::SurfaceIndex surface(mesh.vertices_mm, mesh.triangles);
    const auto places = surface.closest(rest_mm_);
    for (const auto& field : unit_fields_) {
        if (field.size() != vertices_mm_.size()) throw InputError("a unit's field is not of this mesh");
        auto& motion = unit_motions_.emplace_back();
        for (const auto& place : places) {
            Vector sum = Vector::Zero();
            for (std::size_t c = 0; c < 3; ++c)
                sum += place.barycentric[static_cast<Eigen::Index>(c)] * field[mesh.triangles[place.triangle][c]];
            motion.push_back(sum);
        }
    }
    unit_weights_.emplace(unit_motions_, options);
}

std::vector<Point> MarkerAnimator::corners_mm(std::span<const Point> markers_mm) const {
    capture::MarkerSequence once(tracked_, 1, 1);
    for (std::size_t k = 0; k < markers_mm.size(); ++k) once.set(0, k, markers_mm[k]);
    const auto derived = capture::derive_markers(once, labels_, set_);
    std::vector<Point> corners;
    for (std::size_t k = 0; k < surface_.corners.size(); ++k)
        corners.push_back(derived.markers.valid(0, k) ? derived.markers.at_mm(0, k)
                                                      : labels_.position_mm(surface_.corners[k]));
    return corners;
}

std::vector<double> MarkerAnimator::weights(std::span<const Point> markers_mm) const {
    if (!unit_weights_) return {};
    std::vector<Vector> motion;
    for (std::size_t k = 0; k < rest_mm_.size(); ++k) motion.emplace_back(markers_mm[k] - rest_mm_[k]);
    return unit_weights_->of(motion);
}

void MarkerAnimator::displace(std::span<const Point> markers_mm, std::span<Vector> displacement_mm) const {
    if (markers_mm.size() != rest_mm_.size() || displacement_mm.size() != vertices_mm_.size())
        throw InputError(fmt::format("{} markers and room for {} vertices; there are {} and {}", markers_mm.size(),
                                     displacement_mm.size(), rest_mm_.size(), vertices_mm_.size()));
    std::vector<Point> left(markers_mm.begin(), markers_mm.end());  // where they would be of what is to be moved yet
    std::fill(displacement_mm.begin(), displacement_mm.end(), Vector(Vector::Zero()));
    if (method_ == MarkerMethod::nearest)
        for (std::size_t v = 0; v < displacement_mm.size(); ++v)
            displacement_mm[v] = markers_mm[nearest_[v]] - rest_mm_[nearest_[v]];
    if (method_ == MarkerMethod::rbf) {
        std::vector<Point> moved(vertices_mm_.size());
        geometry::RadialBasisMap::fit(rest_mm_, markers_mm, options_.basis, tracked_).apply(vertices_mm_, moved);
        for (std::size_t v = 0; v < moved.size(); ++v) displacement_mm[v] = moved[v] - vertices_mm_[v];
    }
    std::vector<Vector> by_units;
    if (unit_weights_) {
        const auto strength = weights(markers_mm);
        by_units.assign(displacement_mm.size(), Vector::Zero());
        for (std::size_t u = 0; u < strength.size(); ++u) {
            if (strength[u] == 0) continue;
            for (std::size_t k = 0; k < left.size(); ++k) left[k] -= strength[u] * unit_motions_[u][k];
            for (std::size_t v = 0; v < by_units.size(); ++v) by_units[v] += strength[u] * unit_fields_[u][v];
        }
    }
    if (has_bones(method_)) bones_.displace(corners_mm(left), displacement_mm);
    for (std::size_t v = 0; v < by_units.size(); ++v) displacement_mm[v] += by_units[v];
}

}  // namespace mimik::animation
