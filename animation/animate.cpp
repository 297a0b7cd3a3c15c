#include "animation/animate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "animation/combine.h"
#include "base/errors.h"
#include "preprocessing/control_pairs.h"

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
    return options;
}

void AnimationOptions::check() const {
    if (!(smoothing >= 0)) throw InputError(fmt::format("smoothing is {}; give 0 or more", smoothing));
    if (!(landmark_smoothing >= 0))
        throw InputError(fmt::format("landmark_smoothing is {}; give 0 or more", landmark_smoothing));
    if (!(border_mm >= 0)) throw InputError(fmt::format("border_mm is {}; give 0 (hard cut) or more", border_mm));
}

TargetFace::TargetFace(const preprocessing::Face& neutral, modeling::Frame frame, bool snapped_landmarks)
    : face_(&neutral), frame_(frame), average_from_scan_(modeling::average_from_scan(neutral, frame)) {
    landmarks_ =
        geometry::transformed(snapped_landmarks ? neutral.snapped_landmarks : neutral.landmarks, average_from_scan_);
    mouth_width_mm_ =
        (landmarks_.position_mm("mouth_corner_left") - landmarks_.position_mm("mouth_corner_right")).norm();
    vertices_mm_.reserve(neutral.grid.size());
    for (std::size_t v = 0; v < neutral.grid.size(); ++v) {
        vertices_mm_.emplace_back(average_from_scan_ * neutral.grid.vertices_mm[v]);
        if (neutral.grid.inside(v)) inside_.push_back(static_cast<std::uint32_t>(v));
    }
    surface_ = std::make_shared<geometry::SurfaceIndex>(vertices_mm_, geometry::triangles(neutral.grid));
}

Point TargetFace::nearest_vertex(const Point& query_mm) const {
    // One answer is asked for per control point: looking at every vertex costs less than building a tree.
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = 0;
    for (const auto v : inside_) {
        const double d = (vertices_mm_[v] - query_mm).squaredNorm();
        if (d < best) {
            best = d;
            nearest = v;
        }
    }
    return vertices_mm_[nearest];
}

namespace {

/// Controls closer than this would make the spline stiff against noise: the later one is merged into the first.
constexpr double merge_mm = 0.5;

struct Controls {
    std::vector<Point> from, to;
    std::vector<std::string> names;
};

Controls carry(const TargetFace& target, const ExpressionModel& model, const AnimationOptions& options,
               std::vector<CarriedPoint>* points, std::vector<std::string>* remarks) {
    const preprocessing::ControlPairs pairs(model.landmarks, target.landmarks());
    if (remarks)
        for (const auto& merged : pairs.merged())
            remarks->push_back(fmt::format("{}: landmark {}", model.expression, merged));
    const auto target_from_model = pairs.fit({.kernel = options.kernel, .smoothing = options.landmark_smoothing});

    double ratio = 1.0;
    if (options.mouth_ratio && model.moves_lower_face && !model.moves_upper_face && model.mouth_width_mm > 0)
        ratio = target.mouth_width_mm() / model.mouth_width_mm;
    const Eigen::Matrix3d scan_from_average = target.average_from_scan().linear().inverse();

    Controls controls;
    for (const auto& point : model.points) {
        const bool anchor = point.kind == modeling::ControlKind::anchor;
        if (anchor && !options.anchors) continue;
        const Point carried = target_from_model(point.position_mm);
        const Point on_face =
            options.snap_to_vertices ? target.nearest_vertex(carried) : target.surface().closest(carried).position_mm;
        const Vector displacement = ratio * point.displacement_mm;
        const auto near = std::find_if(controls.from.begin(), controls.from.end(),
                                       [&](const Point& p) { return (p - on_face).norm() < merge_mm; });
        if (near != controls.from.end()) {
            if (remarks)
                remarks->push_back(fmt::format("{}: '{}' falls on '{}' on this face and was left out", model.expression,
                                               point.name,
                                               controls.names[static_cast<std::size_t>(near - controls.from.begin())]));
            continue;
        }
        controls.from.push_back(on_face);
        controls.to.push_back(on_face + displacement);
        controls.names.push_back(point.name);
        if (points)
            points->push_back({point.name, point.kind, target.average_from_scan().inverse() * on_face,
                               scan_from_average * displacement, (on_face - carried).norm()});
    }
    return controls;
}

}  // namespace

std::vector<Vector> expression_field(const TargetFace& target, const ExpressionModel& model,
                                     const AnimationOptions& options, std::vector<CarriedPoint>* points,
                                     std::vector<std::string>* remarks) {
    options.check();
    if (model.frame != target.frame())
        throw InputError(
            fmt::format("{}: the model is in the {} frame and the target in the other; model and animate with "
                        "the same normalisation",
                        model.expression, model.frame == modeling::Frame::affine ? "affine" : "similarity"));
    const Controls controls = carry(target, model, options, points, remarks);
    const auto warp = geometry::ThinPlateSpline::fit(
        controls.from, controls.to, {.kernel = options.kernel, .smoothing = options.smoothing}, controls.names);

    // An emotion moves both halves; an AU of one half leaves the other alone.
    std::vector<double> weights(target.vertices_mm().size(), 1.0);
    if (model.moves_upper_face != model.moves_lower_face)
        weights = modeling::region_weights(target.face().grid, target.face().landmarks, model.moves_lower_face,
                                           options.border_mm);
    if (!options.keep.empty()) {
        if (options.keep.size() != weights.size())
            throw InputError(fmt::format("keep has {} weights for {} vertices; give one per grid vertex",
                                         options.keep.size(), weights.size()));
        for (std::size_t v = 0; v < weights.size(); ++v) weights[v] *= options.keep[v];
    }
    std::vector<std::uint32_t> moving;
    std::vector<Point> positions;
    for (std::uint32_t v = 0; v < target.vertices_mm().size(); ++v)
        if (target.face().grid.inside(v) && weights[v] > 0) {
            moving.push_back(v);
            positions.push_back(target.vertices_mm()[v]);
        }
    std::vector<Point> warped(positions.size());
    warp.apply(positions, warped);
    std::vector<Vector> field(target.vertices_mm().size(), Vector::Zero());
    for (std::size_t k = 0; k < moving.size(); ++k) field[moving[k]] = weights[moving[k]] * (warped[k] - positions[k]);
    return field;
}

FieldExtent field_extent(const geometry::QuadGrid& grid, std::span<const Vector> field_mm,
                         const Eigen::Matrix3d& frame_from_field) {
    FieldExtent extent;
    const auto keep_largest = [&](double& largest, const Vector& difference) {
        const double length = (frame_from_field * difference).norm();
        if (!(length <= largest)) largest = std::isnan(length) ? std::numeric_limits<double>::infinity() : length;
    };
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const auto a = grid.index(row, col);
            if (!grid.inside(a)) continue;
            keep_largest(extent.largest_displacement_mm, field_mm[a]);
            for (const auto& [r, c] : {std::pair{row + 1, col}, std::pair{row, col + 1}}) {
                if (r >= grid.rows || c >= grid.cols) continue;
                const auto b = grid.index(r, c);
                if (grid.inside(b)) keep_largest(extent.largest_neighbour_step_mm, field_mm[a] - field_mm[b]);
            }
        }
    return extent;
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
        const bool anchor = point.kind == modeling::ControlKind::anchor;
        (anchor ? lip.held : lip.moved) += point.displacement_mm.y();
        ++(anchor ? lip.anchors : lip.points);
    }
    return above.rise_mm() - below.rise_mm();
}

bool lips_closed(const preprocessing::Face& neutral) {
    const auto* upper = neutral.landmarks.find("upper_lip_inner");
    const auto* lower = neutral.landmarks.find("lower_lip_inner");
    const auto* left = neutral.landmarks.find("mouth_corner_left");
    const auto* right = neutral.landmarks.find("mouth_corner_right");
    if (!upper || !lower || !left || !right) return false;
    const auto& grid = neutral.grid;
    const double middle_x = (left->position_mm.x() + right->position_mm.x()) / 2;
    const double quarter_mm = std::abs(left->position_mm.x() - right->position_mm.x()) / 4;
    const auto [low, high] = std::minmax({upper->position_mm.y(), lower->position_mm.y()});
    const double cell_mm = grid.vertices_mm[grid.index(1, 0)].y() - grid.vertices_mm[0].y();
    int columns = 0, open = 0;
    for (int col = 0; col < grid.cols; ++col) {
        if (std::abs(grid.vertices_mm[grid.index(0, col)].x() - middle_x) > quarter_mm) continue;
        bool gap = false;
        for (int row = 0; row < grid.rows; ++row) {
            const auto v = grid.index(row, col);
            const double y = grid.vertices_mm[v].y();
            gap = gap || (y > low - cell_mm && y < high + cell_mm && !grid.measured(v));
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

void remark_closed_lips(const TargetFace& target, std::span<const WeightedExpression> expressions,
                        std::vector<std::string>& remarks) {
    if (!lips_closed(target.face())) return;
    for (const auto& [model, magnitude] : expressions)
        if (magnitude * lip_parting_mm(*model) > parted_mm)
            remarks.push_back(
                fmt::format("{} pulls the lips apart, but those of {} are closed: they are one piece of surface, which "
                            "is stretched and does not open; take a target whose neutral scan has open lips",
                            model->expression, target.face().id.name()));
}

[[noreturn]] void refuse_overflow(const std::string& what) {
    throw NumericalError(
        fmt::format("{}: a displacement is too large for a number; give a smaller magnitude, or a "
                    "model whose displacements are millimetres of a face",
                    what));
}

}  // namespace

AnimatedFace animate(const TargetFace& target, std::span<const WeightedExpression> expressions,
                     const AnimationOptions& options) {
    AnimatedFace result;
    result.grid = target.face().grid;
    result.combination = options.combination;
    const std::size_t n = result.grid.size();
    const Eigen::Matrix3d scan_from_average = target.average_from_scan().linear().inverse();
    for (const auto& [model, magnitude] : expressions) {
        if (!std::isfinite(magnitude) || magnitude < 0)
            throw InputError(
                fmt::format("magnitude of {} is {}; give 0 (neutral) or more", model->expression, magnitude));
        if (magnitude > 1)
            result.remarks.push_back(fmt::format("magnitude of {} is {}: beyond what the source did, so it exaggerates",
                                                 model->expression, magnitude));
        auto field = expression_field(target, *model, options, &result.points, &result.remarks);
        for (auto& displacement : field) displacement = scan_from_average * displacement;
        if (const auto extent = field_extent(result.grid, field, magnitude * Eigen::Matrix3d::Identity());
            !std::isfinite(extent.largest_displacement_mm))
            refuse_overflow(fmt::format("{} at magnitude {}", model->expression, magnitude));
        result.fields_mm.push_back(std::move(field));
    }
    remark_closed_lips(target, expressions, result.remarks);
    result.displacement_mm.assign(n, Vector::Zero());
    std::vector<Vector> pulls(expressions.size());
    for (std::size_t v = 0; v < n; ++v) {
        if (!result.grid.inside(v)) continue;
        for (std::size_t k = 0; k < pulls.size(); ++k) pulls[k] = expressions[k].magnitude * result.fields_mm[k][v];
        if (options.combination == Combination::parallel)
            result.displacement_mm[v] = parallel_resultant(pulls);
        else
            for (const auto& pull : pulls) result.displacement_mm[v] += pull;
        result.grid.vertices_mm[v] += result.displacement_mm[v];
    }
    result.extent = field_extent(result.grid, result.displacement_mm);
    if (!std::isfinite(result.extent.largest_displacement_mm)) refuse_overflow("the expressions together");
    return result;
}

}  // namespace mimik::animation
