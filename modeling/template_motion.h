#pragma once

#include <memory>
#include <vector>

#include "geometry/types.h"
#include "preprocessing/template_registration.h"

namespace mimik::modeling {

/// The motion of an expression on every vertex of a template: dense correspondence.
struct TemplateMotion {
    /// Bends the template on to a face that is to be animated. Models of one gauge share it.
    std::shared_ptr<const preprocessing::TemplateRegistration> registration;
    std::vector<geometry::Vector> motion_mm;  ///< per vertex of the template, average frame, at magnitude 1
};

}  // namespace mimik::modeling
