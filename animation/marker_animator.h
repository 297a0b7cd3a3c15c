#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "animation/planar_bones.h"
#include "animation/prepared_target.h"
#include "animation/unit_weights.h"
#include "base/fields.h"
#include "capture/control_surface.h"
#include "capture/fill_gaps.h"
#include "capture/marker_set.h"
#include "geometry/landmarks.h"
#include "geometry/radial_basis_map.h"

namespace mimik::animation {

/// How markers move a mesh.
enum class MarkerMethod {
    still,       ///< not at all: what there is to gain
    nearest,     ///< every vertex moves as the marker nearest to it
    rbf,         ///< one map of space through all markers (Eqs 13-16), applied to every vertex
    open_bones,  ///< planar bones without masks
    bones,       ///< planar bones with masks (Sanchez et al. 2003)
    units,       ///< AUs as strong as the markers say (UnitWeights)
    units_bones  ///< AUs, and what they leave at the markers by planar bones
};
[[nodiscard]] const char* to_string(MarkerMethod method);  ///< "still", ..., "units-bones"
/// @throws InputError listing those there are.
[[nodiscard]] MarkerMethod parse_marker_method(const std::string& name);
[[nodiscard]] std::span<const MarkerMethod> marker_methods();

/// AUs on a mesh: the motion of every vertex at strength 1.
struct UnitFields {
    std::vector<std::string> names;                        ///< "AU12_L"
    std::vector<std::vector<geometry::Vector>> fields_mm;  ///< [unit][vertex]
};

struct MarkerAnimatorOptions {
    /// Twice the shortest edge: bones reach the rim of lids and the skin under the jaw, and with masks no lip's bone
    /// reaches the other lip.
    PlanarBonesOptions bones = {2.0};
    UnitWeightsOptions units;
    geometry::RadialBasisOptions basis;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("bones", self.bones);
        visit("units", self.units);
        visit("basis", self.basis);
    }
};
static_assert(base::lists_every_field<MarkerAnimatorOptions>());

/// Moves the vertices of a mesh as markers move that are labelled on it.
class MarkerAnimator {
public:
    /// What a method stands on.
    struct Mesh {
        std::span<const geometry::Point> vertices_mm;   ///< at rest
        std::span<const geometry::Triangle> triangles;  ///< of the surface
        std::span<const std::uint32_t> parts;           ///< per vertex (vertex_parts); empty: no masks
        const UnitFields* units = nullptr;              ///< for methods that ask for them
    };
    /// @param labels  where the markers are on the mesh at rest, and derived points, which follow as the set says
    /// @param tracked  names of those whose motion will be given, in the order of displace()
    /// @throws InputError if a tracked marker has no label, or the method lacks what it needs.
    MarkerAnimator(MarkerMethod method, const Mesh& mesh, const capture::MarkerSet& set,
                   const geometry::Landmarks& labels, std::vector<std::string> tracked,
                   const MarkerAnimatorOptions& options = {});

    [[nodiscard]] MarkerMethod method() const { return method_; }
    [[nodiscard]] std::span<const geometry::Point> rest_mm() const { return rest_mm_; }  ///< of the tracked markers
    [[nodiscard]] const capture::ControlSurface& surface() const { return surface_; }    ///< of methods with bones
    [[nodiscard]] std::size_t vertices() const { return vertices_mm_.size(); }

    /// One frame. @param markers_mm  of the tracked markers  @param displacement_mm  per vertex
    void displace(std::span<const geometry::Point> markers_mm, std::span<geometry::Vector> displacement_mm) const;
    /// The strengths of the units of that frame; empty of methods without units.
    [[nodiscard]] std::vector<double> weights(std::span<const geometry::Point> markers_mm) const;

private:
    void bind_bones(const Mesh& mesh, const capture::MarkerSet& set, const geometry::Landmarks& labels,
                    const PlanarBonesOptions& options);
    void bind_units(const Mesh& mesh, const UnitWeightsOptions& options);
    /// Where the corners of the control surface are, from the tracked markers: derived ones follow.
    [[nodiscard]] std::vector<geometry::Point> corners_mm(std::span<const geometry::Point> markers_mm) const;

    MarkerMethod method_;
    MarkerAnimatorOptions options_;
    capture::MarkerSet set_;
    geometry::Landmarks labels_;
    std::vector<std::string> tracked_;
    std::vector<geometry::Point> rest_mm_;
    std::vector<geometry::Point> vertices_mm_;
    std::vector<std::uint32_t> nearest_;
    capture::ControlSurface surface_;
    PlanarBones bones_;
    std::optional<UnitWeights> unit_weights_;
    std::vector<std::vector<geometry::Vector>> unit_fields_, unit_motions_;
};

}  // namespace mimik::animation
