#include "preprocessing/template_registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/landmark_spline.h"
#include "geometry/point_index.h"

namespace mimik::preprocessing {

using geometry::Point;
using geometry::Vector;

void TemplateRegistrationOptions::check() const {
    neutral.check();
    expressive.check();
    if (!(landmark_smoothing >= 0))
        throw InputError(fmt::format("landmark_smoothing is {}; give 0 or more", landmark_smoothing));
    const auto above_zero = [](const char* name, double value) {
        if (!(value > 0)) throw InputError(fmt::format("{} is {}; give more than 0", name, value));
    };
    above_zero("still_around_mm", still_around_mm);
    above_zero("still_within_mm", still_within_mm);
    above_zero("still_off_marks_mm", still_off_marks_mm);
    above_zero("still_doubt_mm", still_doubt_mm);
    above_zero("still_spacing_mm", still_spacing_mm);
    above_zero("far_stillness", far_stillness);
    if (!(far_from_mm >= 0 && far_to_mm > far_from_mm))
        throw InputError(fmt::format("stillness rises from {} to {} mm; give a farther end", far_from_mm, far_to_mm));
    if (!(far_growth >= 0 && std::isfinite(far_growth)))
        throw InputError(fmt::format("far_growth is {}; give 0 or more", far_growth));
    if (!(arcs_from_parting_mm >= 0))
        throw InputError(fmt::format("arcs_from_parting_mm is {}; give 0 or more", arcs_from_parting_mm));
    if (!(least_matched >= 0 && least_matched <= 1))
        throw InputError(fmt::format("least_matched is {}; give a share from 0 to 1", least_matched));
    if (!(still_motion_mm >= 0))
        throw InputError(fmt::format("still_motion_mm is {}; give 0 or more", still_motion_mm));
}

namespace {

/// What was measured of a face, in the average frame of its subject.
FitTarget measured_surface(const Face& face) {
    std::vector<Point> vertices;
    vertices.reserve(face.grid.size());
    for (std::size_t v = 0; v < face.grid.size(); ++v)
        vertices.push_back(face.grid.inside(v) ? Point(face.average_from_scan * face.grid.vertices_mm[v])
                                               : Point(Point::Zero()));
    return {vertices, geometry::triangles(face.grid, geometry::BridgedVertices::leave_out)};
}

geometry::Landmarks in_average_frame(const Face& face) {
    return geometry::transformed(face.landmarks, face.average_from_scan);
}

}  // namespace

TemplateRegistration::TemplateRegistration(FaceTemplate face_template, const TemplateRegistrationOptions& options)
    : template_(std::move(face_template)),
      options_(options),
      lip_shares_(lip_shares(template_)),
      lip_rims_(template_.size(), 0),
      fitter_(template_.surface.vertices_mm, template_.surface.triangles) {
    options_.check();
    for (const auto* line : {&template_.upper_lip_line, &template_.lower_lip_line})
        for (const auto v : *line) lip_rims_[v] = 1;
}

namespace {

geometry::Landmarks without(const geometry::Landmarks& landmarks, std::span<const std::string_view> names) {
    std::vector<geometry::Landmark> kept;
    for (const auto& mark : landmarks.all())
        if (std::find(names.begin(), names.end(), mark.name) == names.end()) kept.push_back(mark);
    return geometry::Landmarks(std::move(kept));
}

constexpr std::array<std::string_view, 2> upper_lip = {"upper_lip_inner", "upper_lip_outer"};
constexpr std::array<std::string_view, 2> lower_lip = {"lower_lip_inner", "lower_lip_outer"};

/// How much farther apart the inner lips are; 0 where one is not marked.
double parting_mm(const geometry::Landmarks& from, const geometry::Landmarks& to) {
    const auto apart_mm = [](const geometry::Landmarks& landmarks) -> std::optional<double> {
        const auto *upper = landmarks.find(upper_lip[0]), *lower = landmarks.find(lower_lip[0]);
        if (!upper || !lower) return std::nullopt;
        return (upper->position_mm - lower->position_mm).norm();
    };
    const auto before = apart_mm(from), after = apart_mm(to);
    return before && after ? *after - *before : 0.0;
}

/// Of lips that part, a landmark on the middle of a lip says where its whole line goes: half an ellipse from corner to
/// corner. A spline that knew the middle alone would pull the lip into a point.
void add_arc(geometry::LandmarkPairs& pairs, const geometry::Landmarks& from, const geometry::Landmarks& to,
             std::string_view middle) {
    const auto on_arc = [&](const geometry::Landmarks& landmarks, double aside) -> std::optional<Point> {
        const auto *left = landmarks.find("mouth_corner_left"), *right = landmarks.find("mouth_corner_right"),
                   *mid = landmarks.find(middle);
        if (!left || !right || !mid) return std::nullopt;
        const Point chord = (left->position_mm * (1 + aside) + right->position_mm * (1 - aside)) / 2;
        const Point corners = (left->position_mm + right->position_mm) / 2;
        return chord + std::sqrt(1 - aside * aside) * (mid->position_mm - corners);
    };
    for (const double aside : {-0.9, -0.7, -0.5, -0.25, 0.25, 0.5, 0.7, 0.9}) {
        const auto begin = on_arc(from, aside), end = on_arc(to, aside);
        if (begin && end) pairs.add(fmt::format("{} {}", middle, aside), *begin, *end);
    }
}

}  // namespace

/// By the spline through landmarks and what holds still; near the cut each lip goes by a spline that knows nothing of
/// the other, since one spline has no cut.
std::vector<Point> TemplateRegistration::start(const geometry::Landmarks& from, const geometry::Landmarks& to,
                                               std::span<const Point> still_mm,
                                               std::span<const Point> vertices_mm) const {
    const bool part = parting_mm(from, to) > options_.arcs_from_parting_mm;
    const auto carried = [&](std::span<const std::string_view> left_out) {
        geometry::LandmarkPairs pairs(without(from, left_out), without(to, left_out));
        for (const auto* lip : {&upper_lip, &lower_lip})
            if (part && !left_out.empty() && lip->front() != left_out.front())
                for (const auto middle : *lip) add_arc(pairs, from, to, middle);
        for (std::size_t k = 0; k < still_mm.size(); ++k)
            pairs.add(fmt::format("still_{}", k), still_mm[k], still_mm[k]);
        return pairs.fit({.smoothing = options_.landmark_smoothing}).apply(vertices_mm);
    };
    auto start = carried({});
    const auto of_upper = carried(lower_lip), of_lower = carried(upper_lip);
    for (std::size_t v = 0; v < start.size(); ++v) {
        const double share = lip_shares_[v];
        start[v] += std::abs(share) * ((share > 0 ? of_upper : of_lower)[v] - start[v]);
    }
    return start;
}

/// @throws NumericalError if too little of the template lies on the surface for the rest to be believed.
void TemplateRegistration::judge(const NonrigidFit& fit) const {
    if (fit.matched_share < options_.least_matched)
        throw NumericalError(fmt::format(
            "only {:.0f} % of the template lie on the scan, {:.0f} % are needed: is this a face in mm, and are its "
            "landmarks at their places?",
            100 * fit.matched_share, 100 * options_.least_matched));
}

std::vector<FitMark> TemplateRegistration::marks(const geometry::Landmarks& landmarks) const {
    std::vector<FitMark> marks;
    for (const auto& bound : template_.landmarks)
        if (const auto* mark = landmarks.find(bound.name))
            marks.push_back({bound.corners, bound.weights, mark->position_mm, 1.0});
    return marks;
}

RegisteredTemplate TemplateRegistration::neutral(const Face& face) const {
    return neutral(measured_surface(face), in_average_frame(face));
}

RegisteredTemplate TemplateRegistration::neutral(const FitTarget& surface, const geometry::Landmarks& landmarks) const {
    const auto begin = start(template_.surface.landmarks, landmarks, {}, template_.surface.vertices_mm);
    auto fit = fitter_.fit(begin, surface, marks(landmarks), options_.neutral, {.on_rim = lip_rims_});
    judge(fit);
    return {std::move(fit.vertices_mm), std::move(fit.matched), fit.matched_share, fit.residual_rms_mm};
}

namespace {

constexpr double moved_mark_mm = 1.0;  // above what marking errs by

/// Vertices of the neutral template that the expression demonstrably leaves where they are.
std::vector<Point> still_points(std::span<const Point> vertices_mm, std::span<const geometry::Triangle> triangles,
                                const FitTarget& surface, std::span<const geometry::LandmarkPair> marks,
                                const TemplateRegistrationOptions& options) {
    constexpr double least_cosine = 0.97;
    const auto normals = geometry::vertex_normals(vertices_mm, triangles);
    const auto hits = surface.surface().closest(vertices_mm);
    geometry::VertexMask unmoved(vertices_mm.size(), 0);
    for (std::size_t v = 0; v < unmoved.size(); ++v)
        unmoved[v] = hits[v].distance_mm < options.still_within_mm && !surface.surface().on_border(hits[v]) &&
                     normals[v].dot(surface.normal(hits[v])) > least_cosine;
    const geometry::PointIndex index(vertices_mm);
    std::vector<Point> still;
    for (std::size_t v = 0; v < unmoved.size(); ++v) {
        if (!unmoved[v]) continue;
        const Point& p = vertices_mm[v];
        const auto near = [&](const Point& q, double mm) { return (p - q).squaredNorm() < mm * mm; };
        bool holds = true, doubtful = false;
        for (const auto& other : still) holds = holds && !near(other, options.still_spacing_mm);
        for (const auto& mark : marks) {
            if ((mark.target_mm - mark.source_mm).norm() <= moved_mark_mm) continue;
            holds = holds && !near(mark.source_mm, options.still_off_marks_mm);
            doubtful = doubtful || near(mark.source_mm, options.still_doubt_mm);
        }
        if (!holds) continue;
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        const auto around = index.within(p, options.still_around_mm);
        for (const auto& neighbour : around) {
            holds = holds && unmoved[neighbour.index];
            spread += normals[neighbour.index] * normals[neighbour.index].transpose();
        }
        // A plane or a cylinder that slides along itself looks as if it held still.
        if (holds && doubtful)
            holds = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread / static_cast<double>(around.size()),
                                                                   Eigen::EigenvaluesOnly)
                        .eigenvalues()[0] > options.still_relief;
        if (holds) still.push_back(p);
    }
    return still;
}

/// Skin slides less the farther it is from a landmark that moved; where it is smooth, no scan shows that.
std::vector<double> stillness(std::span<const Point> vertices_mm, std::span<const geometry::LandmarkPair> marks,
                              const TemplateRegistrationOptions& options) {
    double largest_mm = 0;
    for (const auto& mark : marks) largest_mm = std::max(largest_mm, (mark.target_mm - mark.source_mm).norm());
    constexpr double small_mm = 10.0;
    const double grown = 1.0 + options.far_growth * std::max(0.0, largest_mm - small_mm) / small_mm;
    std::vector<double> weights;
    for (const auto& p : vertices_mm) {
        double nearest = 1e9;
        for (const auto& mark : marks)
            if ((mark.target_mm - mark.source_mm).norm() > moved_mark_mm)
                nearest = std::min(nearest, (p - mark.source_mm).norm());
        const double t =
            std::clamp((nearest / grown - options.far_from_mm) / (options.far_to_mm - options.far_from_mm), 0.0, 1.0);
        weights.push_back(1.0 + (options.far_stillness - 1.0) * t * t * (3 - 2 * t));
    }
    return weights;
}

}  // namespace

RegisteredMotion TemplateRegistration::motion(const Face& neutral, const RegisteredTemplate& registered,
                                              const Face& expressive) const {
    const auto surface = measured_surface(expressive);
    const auto neutral_marks = in_average_frame(neutral), expressive_marks = in_average_frame(expressive);
    const auto marked = geometry::pair_by_name(neutral_marks, expressive_marks).pairs;
    const auto still = still_points(registered.vertices_mm, template_.surface.triangles, surface, marked, options_);
    const auto begin = start(neutral_marks, expressive_marks, still, registered.vertices_mm);
    const auto holding = stillness(registered.vertices_mm, marked, options_);
    auto fit = fitter_.fit(begin, surface, marks(expressive_marks), options_.expressive,
                           {.rest_mm = registered.vertices_mm, .stillness = holding, .on_rim = lip_rims_});
    judge(fit);

    RegisteredMotion motion{{}, std::move(fit.matched), still.size(), fit.matched_share, fit.residual_rms_mm};
    const double noise2 = options_.still_motion_mm * options_.still_motion_mm;
    for (std::size_t v = 0; v < registered.vertices_mm.size(); ++v) {
        const Vector way = fit.vertices_mm[v] - registered.vertices_mm[v];
        const double way2 = way.squaredNorm();
        motion.motion_mm.emplace_back(way2 > 0 ? Vector(way * (way2 / (way2 + noise2))) : way);
    }
    return motion;
}

}  // namespace mimik::preprocessing
