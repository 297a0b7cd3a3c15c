#pragma once

#include <cstddef>
#include <span>

#include "base/fields.h"
#include "capture/label_fit.h"
#include "geometry/landmarks.h"
#include "geometry/mesh.h"
#include "preprocessing/nonrigid_fit.h"

namespace mimik::animation {

struct DenseLabelFitOptions {
    /// As templates are bent on to neutral scans (preprocessing::TemplateRegistrationOptions::neutral).
    preprocessing::NonrigidFitOptions fit = {.first_smoothness = 10, .stages = 3};
    /// Of the reference, what lies within this of a label takes part: hair and neck say nothing of a face.
    double around_mm = 25.0;
    double least_matched = 0.5;  ///< a fit with fewer of its vertices on the target is refused
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("fit", self.fit);
        visit("around_mm", self.around_mm);
        visit("least_matched", self.least_matched);
    }
    void check() const;  ///< throws InputError naming field, value and range
};
static_assert(base::lists_every_field<DenseLabelFitOptions>());

struct DenselyFittedLabels {
    geometry::Landmarks labels;  ///< on the target; points placed by hand stay where they are
    std::size_t vertices = 0;    ///< of the reference that took part
    double matched_share = 0, residual_rms_mm = 0;
    double seconds = 0;  ///< by the clock
};

/// The labels of a reference face on another one by dense correspondence: the reference is the template that is bent on
/// to the target, from the same start as capture::fit_labels().
/// @param reference_labels  as given to start_labels()
/// @throws NumericalError if less than `least_matched` of the reference comes to lie on the target.
[[nodiscard]] DenselyFittedLabels fit_labels_densely(const capture::LabelStart& start,
                                                     std::span<const geometry::Point> reference_mm,
                                                     std::span<const geometry::Triangle> reference_triangles,
                                                     const geometry::Landmarks& reference_labels,
                                                     const preprocessing::FitTarget& target,
                                                     const DenseLabelFitOptions& options = {});

}  // namespace mimik::animation
