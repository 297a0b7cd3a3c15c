#pragma once

#include "database/truth.h"
#include "geometry/face_surface.h"
#include "preprocessing/template_registration.h"

namespace mimik::builtin {

/// Where the vertices of a template lie on the mesh of a face: the template is bent on to it, and each vertex goes to
/// the nearest point, those beside the cut to the nearest of their own lip.
/// @param mesh  with its landmarks, average frame. @throws as TemplateRegistration::neutral.
[[nodiscard]] database::MaterialPoints template_on_mesh(const preprocessing::TemplateRegistration& registration,
                                                        const geometry::FaceSurface& mesh);

}  // namespace mimik::builtin
