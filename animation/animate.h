#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "animation/lid_field.h"
#include "animation/prepared_target.h"
#include "base/fields.h"
#include "geometry/face_surface.h"
#include "geometry/thin_plate_spline.h"
#include "modeling/expression_model.h"

namespace mimik::animation {

/// How several AUs at once become one displacement per vertex.
enum class Combination {
    sum,      ///< the displacements of the AUs add
    parallel  ///< Bui's way: contractions that pull one point at the same time give a resultant inside the span of the
              ///< pulls (combine.h has the formula); two equal AUs do not double
};

[[nodiscard]] constexpr const char* to_string(Combination combination) {
    return combination == Combination::parallel ? "parallel" : "sum";
}

struct AnimationOptions {
    geometry::SplineKernel kernel = geometry::SplineKernel::r;
    double smoothing = 0.0;  ///< of the warp, unit of the kernel
    /// Of the spline that carries the controls (Eq. 5.7), unit of the kernel. Landmarks are marked to 0.5-1 mm only,
    /// and an exact spline hands that on: 10 mm measured better than 0.
    double landmark_smoothing = 10.0;
    bool anchors = true;            ///< the model's anchors hold still in the warp
    bool mouth_ratio = true;        ///< Eq. 5.8: lower-face AUs scale with the mouth width
    bool snap_to_vertices = false;  ///< carried points go to the nearest vertex (thesis), not the nearest surface point
    double border_mm = 12.0;        ///< width over which an AU fades at the border of its region; 0: hard cut (thesis)
    Combination combination = Combination::sum;
    bool lids = true;  ///< AU 5, 7 and 41 to 46 slide lids on eyeballs; scanners and splines see little of lids
    /// How much of its displacement each vertex of the target keeps, e.g. modeling::held_weights; empty: all.
    std::vector<double> keep;
    static constexpr std::size_t unlisted = 1;  // keep

    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("kernel", self.kernel);
        visit("smoothing", self.smoothing);
        visit("landmark_smoothing", self.landmark_smoothing);
        visit("anchors", self.anchors);
        visit("mouth_ratio", self.mouth_ratio);
        visit("snap_to_vertices", self.snap_to_vertices);
        visit("border_mm", self.border_mm);
        visit("combination", self.combination);
        visit("lids", self.lids);
    }
    /// The equations of the thesis: r^2 ln r^2, no anchors, hard cut between upper and lower face.
    [[nodiscard]] static AnimationOptions thesis();
    void check() const;
};
static_assert(base::lists_every_field<AnimationOptions>());

struct WeightedExpression {
    const modeling::ExpressionModel* model = nullptr;
    double magnitude = 1.0;  ///< m of Eqs 5.8 and 5.10: 0 neutral, 1 as the source did it; above 1 exaggerates
};

/// One control point on the target, for figures and for those who want to know.
struct CarriedPoint {
    std::string name;
    facs::ControlKind kind = facs::ControlKind::muscle;
    geometry::Point position_mm;       ///< on the target's neutral face, its frame
    geometry::Vector displacement_mm;  ///< at magnitude 1, the target's frame
    double projection_mm = 0.0;        ///< how far the spline's answer lay from the target's surface, average frame
};

/// How far apart an expression pulls the lips at magnitude 1, mm: the mean rise of the model's points on the upper lip
/// less that of those on the lower; negative where it presses them together, 0 without landmarks of the lips.
[[nodiscard]] double lip_parting_mm(const modeling::ExpressionModel& model);

/// Whether the lips of a neutral face are one piece of surface, which can be stretched but not opened: in more than
/// half of the columns of the mouth's middle half all vertices between the inner lips, a cell to spare, were measured.
/// Empty where the surface is no grid or lacks a landmark of the mouth: nothing is known.
[[nodiscard]] std::optional<bool> lips_closed(const geometry::FaceSurface& neutral);

struct AnimatedFace {
    geometry::DisplacementField field;                ///< of all expressions as they are set, the target's frame
    Combination combination = Combination::sum;       ///< of `shapes`, into `field`
    std::vector<geometry::DisplacementField> shapes;  ///< of each expression alone at magnitude 1
    std::vector<CarriedPoint> points;
    std::vector<std::string> remarks;               ///< merged points, magnitudes above 1, closed lips, ...
    geometry::FieldExtent extent;                   ///< of `field`
    std::vector<preprocessing::LipSide> lip_sides;  ///< per vertex, of dense models; else empty
    std::vector<LidSheet> lid_sheets;               ///< per vertex, where lids slide; else empty
};

/// The motion of every vertex under one model at magnitude 1, in the target's frame. The field at another magnitude m
/// is m times this one: the spline is linear in the displacements of its controls. Carries the controls by the landmark
/// spline (Eq. 5.7) and on to the surface, moves them by Eqs 5.8 / 5.10 and warps by the spline of Eq. 5.9. Lids slide
/// on their eyeballs (lid_field.h).
/// @throws InputError for bad options; NumericalError from the splines.
[[nodiscard]] geometry::DisplacementField expression_field(const PreparedTarget& target,
                                                           const modeling::ExpressionModel& model,
                                                           const AnimationOptions& options,
                                                           std::vector<CarriedPoint>* points = nullptr,
                                                           std::vector<std::string>* remarks = nullptr);

/// The same at some vertices alone, of a model of control points without lids: for who asks again and again.
/// @return one displacement per vertex asked for; zero of one that is not present
[[nodiscard]] std::vector<geometry::Vector> displacements_at(const PreparedTarget& target,
                                                             const modeling::ExpressionModel& model,
                                                             const AnimationOptions& options,
                                                             std::span<const std::uint32_t> vertices);

/// Animates a neutral face with one or more expressions. @throws as expression_field; NumericalError naming the
/// expression whose displacements are not finite.
[[nodiscard]] AnimatedFace animate(const PreparedTarget& target, std::span<const WeightedExpression> expressions,
                                   const AnimationOptions& options = {});

/// Anybody's mesh, animated: its own vertices, faces, texture and attributes, moved by expressions of a workspace.
/// @param landmarks  on the mesh, our names, in its frame: +x the subject's left, +y up, +z out of the face, mm.
/// @param animated   what else is known of the animation; may be null.
/// @throws as animate; InputError if the mesh has no face or a landmark is missing.
[[nodiscard]] geometry::Mesh animate_mesh(const geometry::Mesh& mesh, const geometry::Landmarks& landmarks,
                                          const preprocessing::AverageFace& average,
                                          std::span<const WeightedExpression> expressions,
                                          const AnimationOptions& options = {}, AnimatedFace* animated = nullptr);

}  // namespace mimik::animation
