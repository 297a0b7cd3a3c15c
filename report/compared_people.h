#pragma once

#include <optional>
#include <string>
#include <vector>

#include "animation/animate.h"
#include "animation/method.h"
#include "evaluation/scored_target.h"
#include "facs/facs_catalogue.h"
#include "geometry/mesh.h"
#include "geometry/quad_grid.h"
#include "modeling/expression_model.h"
#include "modeling/source_expression.h"
#include "preprocessing/workspace.h"
#include "report/hole_drawing.h"

// Who stands in a figure that compares faces, and what was done to them: what every picture of an expression is drawn
// from, the panels (comparison_panels.h) as well as the figures of the thesis (named_figure.h).

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
    HoleDrawing holes = HoleDrawing::fill;
};

/// How near an animated face comes to the real expressive scan of the same person, in the AU's zone as the catalogue
/// draws it. The scan was brought onto the neutral one by its stable region: a truth, where there is one, is not used.
struct ComparedPerson {
    std::string subject;
    double zone_mm = 0, zone_nothing_mm = 0;         ///< mean distance to the real scan in the zone; of doing nothing
    std::optional<double> face_mm, face_nothing_mm;  ///< the same over the whole face; none: not measured
    std::size_t border_hits = 0;  ///< measured vertices whose nearest point is on the scan's border: left out of all
    [[nodiscard]] std::optional<double> explained() const;  ///< 1 - distance / distance of doing nothing
};

/// Everything that can be found out about a request before any work. Gives the scan that the expression is taken from
/// (none for a mean) and the target's real one (none if the target was not scanned with it).
/// @throws InputError if a subject is missing or must not be shown, the source (of a mean: everybody) lacks the
/// expression, or the model has no mean.
struct ComparedScans {
    std::optional<database::ScanId> source, target;
};
[[nodiscard]] ComparedScans compared_scans(const preprocessing::Workspace& workspace,
                                           const facs::FacsCatalogue& catalogue, const ComparisonRequest& request);

/// A control point of a person in a figure.
struct ShownControl {
    std::string name;
    facs::ControlKind kind = facs::ControlKind::muscle;
    geometry::Point position_mm = geometry::Point::Zero();
};

/// One person of a figure. All points are in the scanner frame of the person's neutral scan, mm.
struct ShownPerson {
    explicit ShownPerson(std::string part) : role(std::move(part)) {}
    std::string role;  ///< "source", "target", "average"
    preprocessing::Face neutral;
    animation::AnimatedFace animated;
    std::vector<ShownControl> controls;              ///< on the neutral face
    std::vector<ShownControl> real_controls;         ///< on the real scan, frame of the neutral one
    std::optional<preprocessing::Face> real;         ///< in its own scanner frame
    std::optional<evaluation::ScoredTarget> scored;  ///< with a real scan only
    ComparedPerson compared;
};

/// A request, carried out.
struct ComparedPeople {
    std::vector<ShownPerson> people;  ///< source (or average face), then target; one of the two where they are one
    double scale_mm = 0.0;            ///< 99th percentile of doing nothing, the greatest of all people; 0: no real scan
    std::vector<std::string> remarks;   ///< what is left out, and why
    std::vector<std::string> failures;  ///< scans that should have gone into a mean and could not
};

/// Animates source and target and measures both against their real scans.
/// @throws as compared_scans; NumericalError from the splines.
[[nodiscard]] ComparedPeople compare_people(const preprocessing::Workspace& workspace,
                                            const facs::FacsCatalogue& catalogue, const ComparisonRequest& request);

/// The request's method at work on one face by a model that is there already.
[[nodiscard]] animation::AnimatedFace animated_face(const animation::PreparedTarget& target,
                                                    const modeling::ExpressionModel& model,
                                                    const ComparisonRequest& request, double magnitude);

/// A method that is no model of control points. Null: the request's own options make the motion.
[[nodiscard]] animation::MethodPointer field_method(const ComparisonRequest& request);

/// From whom the request takes its expression; hidden subjects are no sources anyway.
[[nodiscard]] modeling::ExpressionSource source_of(const ComparisonRequest& request);

/// Adds each remark once.
void add_remarks(std::vector<std::string>& remarks, const std::vector<std::string>& more);
/// What a model left out, with its expression, and the scans that its mean could not use.
void add_left_out(std::vector<std::string>& remarks, const modeling::ExpressionModel& model);
void add_unusable(std::vector<std::string>& failures, const modeling::ExpressionModel& model);

/// The vertices of a person's neutral face, animated.
[[nodiscard]] std::vector<geometry::Point> moved_vertices(const geometry::QuadGrid& grid,
                                                          const animation::AnimatedFace& animated);

/// Distances to the real scan per vertex of a mesh made from a grid: NaN, drawn in grey, where no distance can be had.
/// @param kept  grid index of every vertex of the mesh
[[nodiscard]] geometry::VertexAttribute distance_attribute(const evaluation::ScoredTarget& scored,
                                                           const std::vector<geometry::Point>& vertices_mm,
                                                           const std::vector<std::uint32_t>& kept);

}  // namespace mimik::report
