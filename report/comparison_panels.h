#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "facs/facs_catalogue.h"
#include "preprocessing/workspace.h"
#include "report/compared_people.h"

namespace mimik::report {

struct ComparisonFigure {
    std::filesystem::path description;  ///< figure description (docs/figures.md), beside the files that it names
    std::size_t panels = 0;
    std::vector<ComparedPerson> people;  ///< those with a real expressive scan: source, then target
    double scale_mm = 0.0;               ///< upper end of the colours; 0: nothing is coloured
    std::vector<std::string> remarks;    ///< what is left out, and why
    std::vector<std::string> failures;   ///< scans that should have gone into a mean and could not
};

/// File name without extension: "AU12_bs003_on_bs007_default"; a magnitude other than 1 as "AU12_m0.5_...";
/// what differs from the method and from the front view as "..._r2logr_no-anchors_left_holes-gap". Another catalogue is
/// not told.
[[nodiscard]] std::string comparison_name(const ComparisonRequest& request);
/// "AU4_AU12_series_mean_on_bs007_default".
[[nodiscard]] std::string series_name(const ComparisonRequest& request, std::span<const facs::Expression> expressions);

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
