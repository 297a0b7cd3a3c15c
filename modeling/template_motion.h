#pragma once

#include <memory>
#include <vector>

#include "facs/expression.h"
#include "geometry/types.h"
#include "preprocessing/face.h"
#include "preprocessing/face_template.h"

namespace mimik::preprocessing {
class KeptRegistrations;
}

namespace mimik::modeling {

/// The motion of an expression on every vertex of a template: dense correspondence.
struct TemplateMotion {
    /// The template on the faces it was learned from, and on those that are to be animated. Models of one gauge share
    /// them.
    std::shared_ptr<const preprocessing::KeptRegistrations> registrations;

    std::vector<geometry::Vector> motion_mm;  ///< per vertex of the template, average frame, at magnitude 1
    /// The motion is that of the template's own skin: on a face it turns with the skin there (skin_turns).
    bool follows_skin = false;

    [[nodiscard]] const preprocessing::FaceTemplate& face_template() const;
};

/// What one person shows, on the template: a motion that follows the skin. @throws as KeptRegistrations::motion.
[[nodiscard]] TemplateMotion motion_on_template(
    const std::shared_ptr<const preprocessing::KeptRegistrations>& registrations, const preprocessing::Face& neutral,
    const preprocessing::Face& expressive);

/// Of a scan that shows both sides, an expression of one side takes that alone: smooth over 20 mm about the mid-line.
void keep_side(TemplateMotion& dense, const facs::Expression& expression);

/// Models that stand on one template share what is known of faces: a motion whose template is equal to that of `known`
/// takes those in the place of its own.
void share_registrations(TemplateMotion& dense, const std::shared_ptr<const preprocessing::KeptRegistrations>& known);

}  // namespace mimik::modeling
