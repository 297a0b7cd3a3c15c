#pragma once

#include <memory>
#include <span>
#include <vector>

#include "animation/prepared_target.h"
#include "geometry/face_surface.h"
#include "modeling/template_motion.h"

namespace mimik::animation {

/// Beyond the template's rim a motion fades to nothing over this way, average frame: a jaw drop moves the skin under
/// the chin, never the collar.
constexpr double rim_fade_mm = 30.0;

/// A dense motion at magnitude 1 on the neutral surface of a target, in the target's frame. The template is bent on to
/// the target when this registration first asks, and kept with it; a vertex takes the motion of the template's point
/// that lies nearest.
/// @throws InputError, NumericalError if the template does not fit on the target.
[[nodiscard]] geometry::DisplacementField dense_field(const PreparedTarget& target,
                                                      const modeling::TemplateMotion& dense);

/// The template that was bent on to the target, average frame (similarity); kept with it. @throws as dense_field.
[[nodiscard]] std::span<const geometry::Point> template_on(
    const PreparedTarget& target, const std::shared_ptr<const preprocessing::KeptRegistrations>& registrations);

/// Per vertex of the target, on which side of its lips it lies, by the template that was bent on to it.
[[nodiscard]] std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget& target,
                                                            const modeling::TemplateMotion& dense);

}  // namespace mimik::animation
