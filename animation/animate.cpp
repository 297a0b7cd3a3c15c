#include "animation/animate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "animation/combine.h"
#include "animation/dense_field.h"
#include "base/errors.h"
#include "base/text.h"
#include "facs/face_regions.h"
#include "geometry/face_axes.h"
#include "geometry/landmark_spline.h"

namespace mimik::animation {

using geometry::Point;
using geometry::Vector;
using modeling::ExpressionModel;

AnimationOptions AnimationOptions::thesis() {
    AnimationOptions options;
    options.kernel = geometry::SplineKernel::r2_log_r2;
    options.landmark_smoothing = 0.0;
    options.anchors = false;
    options.snap_to_vertices = true;
    options.border_mm = 0.0;
    options.lids = false;
    return options;
}

void AnimationOptions::check() const {
    if (!(smoothing >= 0)) throw InputError(fmt::format("smoothing is {}; give 0 or more", smoothing));
    if (!(landmark_smoothing >= 0))
        throw InputError(fmt::format("landmark_smoothing is {}; give 0 or more", landmark_smoothing));
    if (!(border_mm >= 0)) throw InputError(fmt::format("border_mm is {}; give 0 (hard cut) or more", border_mm));
}

namespace {

/// Controls closer than this would make the spline stiff against noise: the later one is merged into the first.
constexpr double merge_mm = 0.5;

struct Controls {
    std::vector<Point> from, to;
    std::vector<std::string> names;
};

/// Eq. 5.8: lower-face motion grows with the mouth.
double mouth_ratio(const geometry::Landmarks& target_landmarks, const ExpressionModel& model,
                   const AnimationOptions& options) {
    if (!options.mouth_ratio || !model.moves_lower_face || model.moves_upper_face || model.mouth_width_mm <= 0)
        return 1.0;
    return geometry::mouth_width_mm(target_landmarks) / model.mouth_width_mm;
}

/// The model's landmarks and the target's; what found no partner is told.
geometry::LandmarkPairs paired_landmarks(const ExpressionModel& model, const geometry::Landmarks& landmarks,
                                         const std::string& target, std::vector<std::string>* remarks) {
    geometry::LandmarkPairs pairs(model.landmarks, landmarks);
    if (!remarks) return pairs;
    for (const auto& merged : pairs.merged())
        remarks->push_back(fmt::format("{}: landmark {}", model.expression.name(), merged));
    for (const auto& name : pairs.only_in_from())
        remarks->push_back(fmt::format("{}: landmark '{}' of the model is not on {}; the spline goes by the others",
                                       model.expression.name(), name, target));
    for (const auto& name : pairs.only_in_to())
        remarks->push_back(fmt::format("{}: landmark '{}' of {} is not in the model; the spline goes by the others",
                                       model.expression.name(), name, target));
    return pairs;
}

Controls carry(const PreparedTarget& target, const ExpressionModel& model, const AnimationOptions& options,
               std::vector<CarriedPoint>* points, std::vector<std::string>* remarks) {
    const auto& normalised = target.normalised(model.normalisation);
    const auto& landmarks = options.snap_to_vertices ? normalised.snapped_landmarks : normalised.landmarks;
    const auto target_from_model = paired_landmarks(model, landmarks, target.name(), remarks)
                                       .fit({.kernel = options.kernel, .smoothing = options.landmark_smoothing});
    const double ratio = mouth_ratio(landmarks, model, options);
    const Eigen::Matrix3d target_from_average = normalised.average_from_target.linear().inverse();

    Controls controls;
    for (const auto& point : model.points) {
        const bool anchor = point.kind == facs::ControlKind::anchor;
        if (anchor && !options.anchors) continue;
        const Point carried = target_from_model(point.position_mm);
        const Point on_face = options.snap_to_vertices ? nearest_vertex(target, normalised, carried)
                                                       : normalised.surface.closest(carried).position_mm;
        const Vector displacement = ratio * point.displacement_mm;
        const auto near = std::find_if(controls.from.begin(), controls.from.end(),
                                       [&](const Point& p) { return (p - on_face).norm() < merge_mm; });
        if (near != controls.from.end()) {
            if (remarks)
                remarks->push_back(fmt::format("{}: '{}' falls on '{}' on this face and was left out",
                                               model.expression.name(), point.name,
                                               controls.names[static_cast<std::size_t>(near - controls.from.begin())]));
            continue;
        }
        controls.from.push_back(on_face);
        controls.to.push_back(on_face + displacement);
        controls.names.push_back(point.name);
        if (points)
            points->push_back({point.name, point.kind, normalised.average_from_target.inverse() * on_face,
                               target_from_average * displacement, (on_face - carried).norm()});
    }
    return controls;
}

/// What AnimationOptions::keep says, if anything.
const std::vector<double>& kept_shares(const geometry::FaceSurface& surface, const AnimationOptions& options) {
    if (!options.keep.empty() && options.keep.size() != surface.size())
        throw InputError(fmt::format("keep has {} for {}; give one per vertex of the target",
                                     base::counted(options.keep.size(), "weight"),
                                     base::counted(surface.size(), "vertex", "vertices")));
    return options.keep;
}

/// How much of the expression each vertex takes: an AU of one half of the face leaves the other alone.
std::vector<double> vertex_weights(const geometry::FaceSurface& surface, const ExpressionModel& model,
                                   const AnimationOptions& options) {
    std::vector<double> weights(surface.size(), 1.0);
    if (model.moves_upper_face != model.moves_lower_face)
        weights = facs::region_weights(surface.vertices_mm, surface.present, surface.landmarks, model.moves_lower_face,
                                       options.border_mm);
    return weights;
}

/// By the spline between the controls, at the vertices asked for.
std::vector<Vector> warped_by(const geometry::ThinPlateSpline& warp, const PreparedTarget& target,
                              const ExpressionModel& model, const std::vector<double>& weights,
                              std::span<const std::uint32_t> vertices) {
    const auto& normalised = target.normalised(model.normalisation);
    std::vector<std::size_t> moving;
    std::vector<Point> positions;
    for (std::size_t k = 0; k < vertices.size(); ++k)
        if (const auto v = vertices[k]; target.surface().present[v] && weights[v] > 0) {
            moving.push_back(k);
            positions.push_back(normalised.vertices_mm[v]);
        }
    std::vector<Point> warped(positions.size());
    warp.apply(positions, warped);
    const Eigen::Matrix3d target_from_average = normalised.average_from_target.linear().inverse();
    std::vector<Vector> displacements(vertices.size(), Vector::Zero());
    for (std::size_t k = 0; k < moving.size(); ++k) {
        const Vector displacement = weights[vertices[moving[k]]] * (warped[k] - positions[k]);
        displacements[moving[k]] = target_from_average * displacement;
    }
    return displacements;
}

std::vector<Vector> sparse_displacements(const PreparedTarget& target, const ExpressionModel& model,
                                         const AnimationOptions& options, std::span<const std::uint32_t> vertices,
                                         std::vector<CarriedPoint>* points, std::vector<std::string>* remarks) {
    const Controls controls = carry(target, model, options, points, remarks);
    const auto warp = geometry::ThinPlateSpline::fit(
        controls.from, controls.to, {.kernel = options.kernel, .smoothing = options.smoothing}, controls.names);
    return warped_by(warp, target, model, vertex_weights(target.surface(), model, options), vertices);
}

geometry::DisplacementField sparse_field(const PreparedTarget& target, const ExpressionModel& model,
                                         const AnimationOptions& options, std::vector<CarriedPoint>* points,
                                         std::vector<std::string>* remarks) {
    std::vector<std::uint32_t> all(target.surface().size());
    std::iota(all.begin(), all.end(), 0U);
    geometry::DisplacementField field;
    field.mm = sparse_displacements(target, model, options, all, points, remarks);
    field.answered = target.surface().present;
    return field;
}

/// An AU of the upper face moves the upper face: from the wings of the nose down to the upper lip its motion fades to
/// none. What a scan shows there is a mouth that was held otherwise, or an error of the fit; either would part closed
/// lips. Of a face without the landmarks nothing is faded.
void keep_mouth_still(const geometry::FaceSurface& surface, geometry::DisplacementField& field) {
    const auto middle = [&](const char* left, const char* right) -> std::optional<Point> {
        const auto *a = surface.landmarks.find(left), *b = surface.landmarks.find(right);
        if (!a || !b) return std::nullopt;
        return Point(0.5 * (a->position_mm + b->position_mm));
    };
    const auto wings = middle("nose_wing_left", "nose_wing_right"), eyes = middle("eye_outer_left", "eye_outer_right");
    const auto lip = middle("upper_lip_outer", "upper_lip_outer"), chin = middle("chin", "chin");
    if (!wings || !eyes || !lip || !chin) return;
    const Vector up = (*eyes - *chin).normalized();
    const double high = up.dot(*wings), low = up.dot(*lip);
    if (!(high > low)) return;
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (!surface.present[v]) continue;
        const double t = std::clamp((up.dot(surface.vertices_mm[v]) - low) / (high - low), 0.0, 1.0);
        field.mm[v] *= t * t * (3 - 2 * t);
    }
}

}  // namespace

geometry::DisplacementField expression_field(const PreparedTarget& target, const ExpressionModel& model,
                                             const AnimationOptions& options, std::vector<CarriedPoint>* points,
                                             std::vector<std::string>* remarks) {
    options.check();
    const auto& keep = kept_shares(target.surface(), options);
    // Where its points are, for figures; they move nothing, so what is left out of them is not said.
    if (model.dense && points) (void)carry(target, model, options, points, nullptr);
    auto field =
        model.dense ? dense_field(target, *model.dense) : sparse_field(target, model, options, points, remarks);
    if (model.dense && model.moves_upper_face && !model.moves_lower_face) keep_mouth_still(target.surface(), field);
    if (options.lids) slide_lids(target, model.expression, field, remarks);
    for (std::size_t v = 0; v < keep.size(); ++v) field.mm[v] *= keep[v];
    return field;
}

std::vector<Vector> displacements_at(const PreparedTarget& target, const ExpressionModel& model,
                                     const AnimationOptions& options, std::span<const std::uint32_t> vertices) {
    options.check();
    return sparse_displacements(target, model, options, vertices, nullptr, nullptr);
}

double lip_parting_mm(const ExpressionModel& model) {
    constexpr double lateral_share = 0.6;  // of half the mouth: beyond it both lips go with the corner
    constexpr double beyond_red_mm = 2.0;  // above the upper and below the lower outer landmark
    const auto* left = model.landmarks.find("mouth_corner_left");
    const auto* right = model.landmarks.find("mouth_corner_right");
    const auto* upper = model.landmarks.find("upper_lip_outer");
    const auto* lower = model.landmarks.find("lower_lip_outer");
    const auto* upper_inner = model.landmarks.find("upper_lip_inner");
    const auto* lower_inner = model.landmarks.find("lower_lip_inner");
    if (!upper_inner) upper_inner = lower_inner;
    if (!lower_inner) lower_inner = upper_inner;
    if (!left || !right || !upper || !lower || !upper_inner) return 0.0;
    const Point corners = (left->position_mm + right->position_mm) / 2;
    const double half_mm = (left->position_mm.x() - right->position_mm.x()) / 2;
    const double middle_y = (upper_inner->position_mm.y() + lower_inner->position_mm.y()) / 2;

    struct Lip {
        double moved = 0, held = 0;
        int points = 0, anchors = 0;
        /// An anchor says something of a lip only where nothing else does.
        [[nodiscard]] double rise_mm() const { return points > 0 ? moved / points : anchors > 0 ? held / anchors : 0; }
    } above, below;
    for (const auto& point : model.points) {
        const double aside = std::abs(point.position_mm.x() - corners.x()) / half_mm;
        if (!(aside < lateral_share)) continue;
        const double seam_y = middle_y + (corners.y() - middle_y) * aside;
        const double y = point.position_mm.y();
        if (y > upper->position_mm.y() + beyond_red_mm || y < lower->position_mm.y() - beyond_red_mm) continue;
        Lip& lip = y > seam_y ? above : below;
        const bool anchor = point.kind == facs::ControlKind::anchor;
        (anchor ? lip.held : lip.moved) += point.displacement_mm.y();
        ++(anchor ? lip.anchors : lip.points);
    }
    return above.rise_mm() - below.rise_mm();
}

std::optional<bool> lips_closed(const geometry::FaceSurface& neutral) {
    if (!neutral.grid) return std::nullopt;
    const auto* upper = neutral.landmarks.find("upper_lip_inner");
    const auto* lower = neutral.landmarks.find("lower_lip_inner");
    const auto* left = neutral.landmarks.find("mouth_corner_left");
    const auto* right = neutral.landmarks.find("mouth_corner_right");
    if (!upper || !lower || !left || !right) return std::nullopt;
    const auto [rows, cols] = *neutral.grid;
    const auto vertex = [cols = cols](int row, int col) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
    };
    const double middle_x = (left->position_mm.x() + right->position_mm.x()) / 2;
    const double quarter_mm = std::abs(left->position_mm.x() - right->position_mm.x()) / 4;
    const auto [low, high] = std::minmax({upper->position_mm.y(), lower->position_mm.y()});
    const double cell_mm = neutral.vertices_mm[vertex(1, 0)].y() - neutral.vertices_mm[0].y();
    int columns = 0, open = 0;
    for (int col = 0; col < cols; ++col) {
        if (std::abs(neutral.vertices_mm[vertex(0, col)].x() - middle_x) > quarter_mm) continue;
        bool gap = false;
        for (int row = 0; row < rows; ++row) {
            const auto v = vertex(row, col);
            const double y = neutral.vertices_mm[v].y();
            gap = gap || (y > low - cell_mm && y < high + cell_mm && !neutral.measured[v]);
        }
        ++columns;
        open += gap ? 1 : 0;
    }
    return 2 * open < columns;
}

namespace {

/// Less is told by expressions that leave the lips together (AU 12, 14, 15, 20: up to 0.5 mm by default), more by those
/// that part them (AU 25 of the built-in faces: 1.3 to 2.5 mm, AU 26 and 27: 2.9 to 10 mm).
constexpr double parted_mm = 1.25;

void remark_closed_lips(const PreparedTarget& target, std::span<const WeightedExpression> expressions,
                        std::vector<std::string>& remarks) {
    if (!lips_closed(target.surface()).value_or(false)) return;
    for (const auto& [model, magnitude] : expressions)
        if (!model->dense && magnitude * lip_parting_mm(*model) > parted_mm)
            remarks.push_back(
                fmt::format("{} pulls the lips apart, but those of {} are closed: they are one piece of surface, which "
                            "is stretched and does not open; take a target whose neutral scan has open lips",
                            model->expression.name(), target.name()));
}

[[noreturn]] void refuse_overflow(const std::string& what) {
    throw NumericalError(
        fmt::format("{}: a displacement is too large for a number; give a smaller magnitude, or a "
                    "model whose displacements are millimetres of a face",
                    what));
}

/// One expression alone at magnitude 1, and what is to be said of it.
geometry::DisplacementField shape_of(const PreparedTarget& target, const WeightedExpression& weighted,
                                     const AnimationOptions& options, AnimatedFace& result) {
    const auto& [model, magnitude] = weighted;
    if (!std::isfinite(magnitude) || magnitude < 0)
        throw InputError(
            fmt::format("magnitude of {} is {}; give 0 (neutral) or more", model->expression.name(), magnitude));
    if (magnitude > 1)
        result.remarks.push_back(fmt::format("magnitude of {} is {}: beyond what the source did, so it exaggerates",
                                             model->expression.name(), magnitude));
    auto shape = expression_field(target, *model, options, &result.points, &result.remarks);
    if (const auto extent = geometry::field_extent(target.surface(), shape.mm, magnitude * Eigen::Matrix3d::Identity());
        !std::isfinite(extent.largest_displacement_mm))
        refuse_overflow(fmt::format("{} at magnitude {}", model->expression.name(), magnitude));
    return shape;
}

}  // namespace

AnimatedFace animate(const PreparedTarget& target, std::span<const WeightedExpression> expressions,
                     const AnimationOptions& options) {
    AnimatedFace result;
    result.combination = options.combination;
    for (const auto& weighted : expressions) result.shapes.push_back(shape_of(target, weighted, options, result));
    remark_closed_lips(target, expressions, result.remarks);
    for (const auto& weighted : expressions)
        if (weighted.model->dense && result.lip_sides.empty())
            result.lip_sides = lip_sides(target, *weighted.model->dense);
    for (const auto& weighted : expressions)
        if (options.lids && result.lid_sheets.empty() && lids_slide(target, weighted.model->expression))
            result.lid_sheets = lid_sheets(target);
    const auto& surface = target.surface();
    result.field = geometry::DisplacementField::still(surface.size());
    result.field.answered = surface.present;
    std::vector<Vector> pulls(expressions.size());
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (!surface.present[v]) continue;
        for (std::size_t k = 0; k < pulls.size(); ++k) pulls[k] = expressions[k].magnitude * result.shapes[k].mm[v];
        if (options.combination == Combination::parallel)
            result.field.mm[v] = parallel_resultant(pulls);
        else
            for (const auto& pull : pulls) result.field.mm[v] += pull;
    }
    if (!result.lid_sheets.empty()) keep_lids_off_eyeballs(target, result.field.mm);
    result.extent = geometry::field_extent(surface, result.field.mm);
    if (!std::isfinite(result.extent.largest_displacement_mm)) refuse_overflow("the expressions together");
    return result;
}

geometry::Mesh animate_mesh(const geometry::Mesh& mesh, const geometry::Landmarks& landmarks,
                            const preprocessing::AverageFace& average, std::span<const WeightedExpression> expressions,
                            const AnimationOptions& options, AnimatedFace* animated) {
    const PreparedTarget target(geometry::face_surface(mesh, landmarks), average);
    auto result = animate(target, expressions, options);
    auto moved = geometry::moved(mesh, result.field);
    if (animated) *animated = std::move(result);
    return moved;
}

}  // namespace mimik::animation
