#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "animation/animate.h"
#include "facs/facs_catalogue.h"
#include "geometry/quad_grid.h"
#include "preprocessing/workspace.h"

namespace mimik::report {

/// What a figure shows: an expression of a source on a target.
struct ComparisonRequest {
    std::string source = "mean";  ///< subject, or "mean" (of all others)
    std::string target;
    facs::Expression expression;
    std::string method_name = "default";  ///< any of animation::known_methods()
    modeling::ModelOptions model;         ///< of a method by control points, with its `animation`; of others not used
    animation::AnimationOptions animation;
    double magnitude = 1.0;
    std::string view = "front";
    geometry::BridgedVertices bridged = geometry::BridgedVertices::leave_out;
};

/// How near an animated face comes to the real expressive scan of the same person, in the AU's zone as the catalogue
/// draws it. The scan was brought onto the neutral one by its stable region: a truth, where there is one, is not used.
struct ComparedPerson {
    std::string subject;
    double zone_mm = 0, zone_nothing_mm = 0;  ///< mean distance to the real scan in the zone; of doing nothing
    double face_mm = 0, face_nothing_mm = 0;  ///< the same over the whole face
    std::size_t border_hits = 0;  ///< measured vertices whose nearest point is on the scan's border: left out of all
    [[nodiscard]] std::optional<double> explained() const;  ///< 1 - distance / distance of doing nothing
};

struct ComparisonFigure {
    std::filesystem::path description;  ///< figure description (docs/figures.md), beside the files that it names
    std::size_t panels = 0;
    std::vector<ComparedPerson> people;  ///< those with a real expressive scan: source, then target
    double scale_mm = 0.0;               ///< upper end of the colours; 0: nothing is coloured
    std::vector<std::string> remarks;    ///< what is left out, and why
    std::vector<std::string> failures;   ///< scans that should have gone into a mean and could not
};

/// File name without extension: "AU12_bs003_on_bs007_default"; a magnitude other than 1 as "AU12_m0.5_...";
/// what differs from the method and from the front view as "..._r2logr_no-anchors_left_bridged". Another catalogue is
/// not told.
[[nodiscard]] std::string comparison_name(const ComparisonRequest& request);
/// "AU4_AU12_series_mean_on_bs007_default".
[[nodiscard]] std::string series_name(const ComparisonRequest& request, std::span<const facs::Expression> expressions);

/// Everything that can be found out about a request before any work. Gives the scan that the expression is taken from
/// (none for a mean) and the target's real one (none if the target was not scanned with it).
/// @throws InputError if a subject is missing or must not be shown, the source (of a mean: everybody) lacks the
/// expression, or the model has no mean.
struct ComparedScans {
    std::optional<database::ScanId> source, target;
};
[[nodiscard]] ComparedScans compared_scans(const preprocessing::Workspace& workspace,
                                           const facs::FacsCatalogue& catalogue, const ComparisonRequest& request);

/// Figs 6-1 to 6-3 and 6-6 of the thesis: one row per person (source, target), each with the neutral face and its
/// control points, the animated face, the real expressive scan, and the distance to that scan in colour, of the
/// animated face and of doing nothing. All files of a person are in the scanner frame of that person's neutral scan,
/// mm, and all panels of a person are centred on one point. The colours go from 0 to the 99th percentile of doing
/// nothing (of both people, the greater). Grey: not measured by one of the two scans. A mean has the average face
/// instead of a source, neutral and moved. A method that is no model of control points has none in the figure, and no
/// row for a mean. Writes meshes, landmarks, controls and figure.json into `folder`; files
/// that an earlier figure.json there names go first.
/// @throws as compared_scans; NumericalError from the splines.
[[nodiscard]] ComparisonFigure write_comparison_panels(const preprocessing::Workspace& workspace,
                                                       const facs::FacsCatalogue& catalogue,
                                                       const ComparisonRequest& request,
                                                       const std::filesystem::path& folder);

/// What write_magnitude_series finds out before any work. @throws as compared_scans; InputError if there is no
/// expression or magnitude, one is negative or no number, or one stands twice (to the six digits that its file name
/// has).
void check_series(const preprocessing::Workspace& workspace, const facs::FacsCatalogue& catalogue,
                  const ComparisonRequest& request, std::span<const facs::Expression> expressions,
                  std::span<const double> magnitudes);

/// Fig. 5-12: the target with each expression (a row) at each magnitude (a column), one frame and centre for all.
/// `request.expression` and its magnitude are not used.
/// @throws as write_comparison_panels and check_series.
[[nodiscard]] ComparisonFigure write_magnitude_series(const preprocessing::Workspace& workspace,
                                                      const facs::FacsCatalogue& catalogue,
                                                      const ComparisonRequest& request,
                                                      std::span<const facs::Expression> expressions,
                                                      std::span<const double> magnitudes,
                                                      const std::filesystem::path& folder);

}  // namespace mimik::report
