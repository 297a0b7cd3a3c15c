#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/quad_grid.h"
#include "geometry/surface_index.h"
#include "geometry/thin_plate_spline.h"
#include "modeling/expression_model.h"
#include "modeling/face_regions.h"
#include "preprocessing/face.h"

namespace mimik::animation {

/// How several AUs at once become one displacement per vertex.
enum class Combination {
    sum,      ///< the displacements of the AUs add
    parallel  ///< Bui's way: contractions that pull one point at the same time give a resultant inside the span of the
              ///< pulls (combine.h has the formula); two equal AUs do not double
};

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
    /// How much of its displacement each grid vertex of the target keeps, e.g. modeling::held_weights; empty: all of
    /// it.
    std::vector<double> keep;

    /// The thesis as printed: r^2 ln r^2, no anchors, hard cut between upper and lower face.
    [[nodiscard]] static AnimationOptions thesis();
    void check() const;
};

/// A neutral face made ready to be animated many times: its surface and landmarks in the average frame.
class TargetFace {
public:
    TargetFace(const preprocessing::Face& neutral, modeling::Frame frame, bool snapped_landmarks = false);

    [[nodiscard]] const preprocessing::Face& face() const { return *face_; }
    [[nodiscard]] modeling::Frame frame() const { return frame_; }
    [[nodiscard]] const geometry::Transform& average_from_scan() const { return average_from_scan_; }
    [[nodiscard]] const geometry::Landmarks& landmarks() const { return landmarks_; }  ///< average frame
    [[nodiscard]] double mouth_width_mm() const { return mouth_width_mm_; }            ///< average frame
    /// Grid vertices in the average frame; those outside the face are NaN and stay where they are.
    [[nodiscard]] std::span<const geometry::Point> vertices_mm() const { return vertices_mm_; }
    [[nodiscard]] const geometry::SurfaceIndex& surface() const { return *surface_; }
    [[nodiscard]] geometry::Point nearest_vertex(const geometry::Point& query_mm) const;

private:
    const preprocessing::Face* face_;
    modeling::Frame frame_;
    geometry::Transform average_from_scan_;
    geometry::Landmarks landmarks_;
    double mouth_width_mm_ = 0;
    std::vector<geometry::Point> vertices_mm_;
    std::vector<std::uint32_t> inside_;
    std::shared_ptr<const geometry::SurfaceIndex> surface_;
};

struct WeightedExpression {
    const modeling::ExpressionModel* model = nullptr;
    double magnitude = 1.0;  ///< m of Eqs 5.8 and 5.10: 0 neutral, 1 as the source did it; above 1 exaggerates
};

/// One control point on the target, for figures and for those who want to know.
struct CarriedPoint {
    std::string name;
    modeling::ControlKind kind = modeling::ControlKind::muscle;
    geometry::Point position_mm;       ///< on the target's neutral face, scanner frame
    geometry::Vector displacement_mm;  ///< at magnitude 1, scanner frame
    double projection_mm = 0.0;        ///< how far the spline's answer lay from the target's surface, average frame
};

/// How far a field moves the vertices inside a grid; infinite where a number is not finite.
struct FieldExtent {
    double largest_displacement_mm = 0.0;
    double largest_neighbour_step_mm = 0.0;  ///< largest change of displacement between neighbouring vertices
};
/// @param frame_from_field  linear part of the way to the frame in which lengths are wanted
[[nodiscard]] FieldExtent field_extent(const geometry::QuadGrid& grid, std::span<const geometry::Vector> field_mm,
                                       const Eigen::Matrix3d& frame_from_field = Eigen::Matrix3d::Identity());

/// How far apart an expression pulls the lips at magnitude 1, mm: the mean rise of the model's points on the upper lip
/// less that of those on the lower; negative where it presses them together, 0 without landmarks of the lips.
[[nodiscard]] double lip_parting_mm(const modeling::ExpressionModel& model);

/// Whether the lips of a neutral face are one piece of surface, which can be stretched but not opened: in more than
/// half of the columns of the mouth's middle half all vertices between the inner lips, a cell to spare, were measured.
/// False where a landmark is missing.
[[nodiscard]] bool lips_closed(const preprocessing::Face& neutral);

struct AnimatedFace {
    geometry::QuadGrid grid;                        ///< scanner frame of the target's neutral scan; origins as there
    std::vector<geometry::Vector> displacement_mm;  ///< per vertex, scanner frame
    Combination combination = Combination::sum;     ///< of fields_mm, into displacement_mm
    std::vector<std::vector<geometry::Vector>> fields_mm;  ///< of each expression alone at magnitude 1, scanner frame
    std::vector<CarriedPoint> points;
    std::vector<std::string> remarks;  ///< merged points, magnitudes above 1, closed lips, ...
    FieldExtent extent;                ///< of displacement_mm, scanner frame
};

/// The displacement of every vertex under one model at magnitude 1, average frame. The field at another magnitude m is
/// m times this one: the spline is linear in the displacements of its controls. Carries the controls by the landmark
/// spline (Eq. 5.7) and on to the surface, moves them by Eqs 5.8 / 5.10 and warps by the spline of Eq. 5.9.
/// @throws InputError if model and target are in different frames; NumericalError from the splines.
[[nodiscard]] std::vector<geometry::Vector> expression_field(const TargetFace& target,
                                                             const modeling::ExpressionModel& model,
                                                             const AnimationOptions& options,
                                                             std::vector<CarriedPoint>* points = nullptr,
                                                             std::vector<std::string>* remarks = nullptr);

/// Animates a neutral face with one or more expressions. @throws as expression_field; NumericalError naming the
/// expression whose displacements are not finite.
[[nodiscard]] AnimatedFace animate(const TargetFace& target, std::span<const WeightedExpression> expressions,
                                   const AnimationOptions& options = {});

}  // namespace mimik::animation
