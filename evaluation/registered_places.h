#pragma once

#include <cstdint>
#include <span>

#include "evaluation/estimated_target.h"
#include "preprocessing/kept_registrations.h"

namespace mimik::evaluation {

/// Where a registration says that the skin of a neutral face's vertices went, scanner frame of the neutral: the
/// template is bent on to the neutral scan and from there on to the expressive one, guided by their landmarks
/// (TemplateRegistration; after Amberg, Romdhani and Vetter 2007), and a vertex moves as the template's nearest point.
/// Unknown are vertices 5 mm or more off the template, and those where it found no sound pair on the expressive scan.
/// @param neutral_from_expressive  brings the expressive scan to the neutral one: what a registration cannot know
/// @throws as TemplateRegistration.
[[nodiscard]] SkinPlaces registered_places(const preprocessing::KeptRegistrations& registrations,
                                           const preprocessing::Face& neutral, const preprocessing::Face& expressive,
                                           const geometry::Transform& neutral_from_expressive,
                                           std::span<const std::uint32_t> vertices);

}  // namespace mimik::evaluation
