#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "capture/marker_set.h"
#include "capture/minimise_surface.h"
#include "capture/surface_energy.h"
#include "geometry/landmarks.h"
#include "geometry/radial_basis_map.h"
#include "geometry/surface_index.h"

namespace mimik::capture {

/// Which pose of the control surface keeps its lengths and angles.
enum class LabelFitRest {
    warped,    ///< the reference's, brought to the target's size and shape by the hand-placed points
    reference  ///< the reference's own
};
[[nodiscard]] const char* to_string(LabelFitRest rest);  ///< "warped", "reference"

struct LabelFitOptions {
    /// Points that lie so nearly in one plane say nothing of what is before and behind it: four that were 0.1 mm off a
    /// plane put labels 98 mm away.
    geometry::RadialBasisOptions basis = {.min_thickness_ratio = 0.02};
    /// A hand-placed point, or a label of the reference, that lies farther off its surface is refused.
    double most_off_mm = 5.0;
    /// A label that the projection moves farther goes to the nearest point of the surface instead.
    double most_projected_mm = 10.0;
    LabelFitRest rest = LabelFitRest::warped;
    SurfaceEnergyOptions energy = {};
    MinimiseSurfaceOptions minimise = {};
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("basis", self.basis);
        visit("most_off_mm", self.most_off_mm);
        visit("most_projected_mm", self.most_projected_mm);
        visit("rest", self.rest);
        visit("energy", self.energy);
        visit("minimise", self.minimise);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<LabelFitOptions>());

/// Where a fit begins: all labels of the reference on the target, by its hand-placed points.
struct LabelStart {
    geometry::RadialBasisMap target_from_reference;
    std::vector<std::string> names;          ///< of the labels, in the reference's order
    std::vector<geometry::Point> warped_mm;  ///< by the map
    std::vector<geometry::Point> start_mm;   ///< on the surface: projected from the axis of the head
    std::vector<std::uint8_t> by_hand;       ///< per label: 1 where its point was given
    std::size_t projected = 0;               ///< the others went to the nearest point of the surface
    std::vector<std::string> remarks;
    [[nodiscard]] geometry::Landmarks labels() const;
};

/// Whether labels lie on their own mesh, and it looks outwards. start_labels() asks the same.
/// @throws InputError naming the label, or what is turned inside out.
void check_reference(const geometry::SurfaceIndex& reference, const geometry::Landmarks& labels,
                     const LabelFitOptions& options = {});

/// @param points  some of the labels on the target, by their names
/// @throws InputError naming a point that no label is called as, one that lies off the surface, and how many are
/// missing; if one mesh is more than twice as large as the other by the points (another unit), or turned inside out;
/// NumericalError if the points lie nearly in one plane.
[[nodiscard]] LabelStart start_labels(const geometry::SurfaceIndex& reference, const geometry::Landmarks& labels,
                                      const geometry::SurfaceIndex& target, const geometry::Landmarks& points,
                                      const LabelFitOptions& options = {});

struct FittedLabels {
    geometry::Landmarks
        labels;  ///< on the target's surface; those that are no corner of the control surface as at the start
    MinimisedSurface found;  ///< of the corners
    std::vector<std::string> corners;
};

/// The labels of a reference face on another one, by a few points placed by hand (Sec. 6 of Sanchez et al. 2003): from
/// the start on, the control surface between the labels is drawn to the target and keeps its shape. Points placed by
/// hand hold still.
/// @param reference_labels  as given to start_labels() @throws as minimise_surface() and control_surface().
[[nodiscard]] FittedLabels fit_labels(const LabelStart& start, const geometry::Landmarks& reference_labels,
                                      const geometry::SurfaceIndex& target, const MarkerSet& set,
                                      SurfaceMinimiser minimiser, const LabelFitOptions& options = {});

}  // namespace mimik::capture
