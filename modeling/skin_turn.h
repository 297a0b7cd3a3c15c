#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "base/fields.h"
#include "geometry/types.h"
#include "preprocessing/face_template.h"

namespace mimik::modeling {

struct SkinTurnOptions {
    /// How wide the surroundings are whose turn a vertex takes: standard deviation of a Gaussian.
    double width_mm = 30.0;
    /// A turn is fitted at every so manyth vertex of the template; the others take those about them.
    int stride = 40;
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("width_mm", self.width_mm);
        visit("stride", self.stride);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<SkinTurnOptions>());

/// How the skin of the upper face is turned from one face to another: at each vertex the rotation that takes its
/// surroundings best to the same place of the other face (Kabsch 1976, weighted by a Gaussian of the distance). The
/// brow slides over the skull, so its motion turns with the forehead. Below the inner corners of the eyes the turn
/// fades; from the level of the tip of the nose down there is none, since it does not pay there (docs/results.md).
/// @param face_template  says by its landmarks and resting vertices where the upper face is
/// @param from_mm, to_mm  the template's vertices on two faces, both in the average frame
/// @returns a rotation per vertex of the template, the identity where the template lacks a landmark
/// @throws InputError if the sizes are not the template's, or an option is out of its range.
[[nodiscard]] std::vector<Eigen::Quaterniond> skin_turns(const preprocessing::FaceTemplate& face_template,
                                                         std::span<const geometry::Point> from_mm,
                                                         std::span<const geometry::Point> to_mm,
                                                         const SkinTurnOptions& options = {});

}  // namespace mimik::modeling
