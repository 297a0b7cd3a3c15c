#include "capture/label_fit.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text.h"
#include "capture/control_surface.h"
#include "capture/cylindrical_projection.h"
#include "geometry/rigid_fit.h"

namespace mimik::capture {

using geometry::Landmarks;
using geometry::Point;
using geometry::Vector;

namespace {

/// Root mean square of the distances from the middle.
double spread_mm(std::span<const Point> points) {
    Point middle = Point::Zero();
    for (const auto& p : points) middle += p / static_cast<double>(points.size());
    double squares = 0;
    for (const auto& p : points) squares += (p - middle).squaredNorm();
    return std::sqrt(squares / static_cast<double>(points.size()));
}

/// Faces of people differ by less than a factor of two; units by more.
void check_sizes(std::span<const Point> from, std::span<const Point> to) {
    constexpr double most = 2;
    const double times = spread_mm(to) / spread_mm(from);
    if (times <= most && times >= 1 / most) return;
    throw InputError(fmt::format(
        "the points lie {:.3g} times as far apart as the same labels of the reference; mend the unit of one "
        "of the two meshes",
        times));
}

/// Three quarters of the labels lie where the surface looks away from the axis of the head, or it is turned inside out.
void check_winding(const std::optional<HeadCylinder>& cylinder, std::span<const Point> points,
                   const geometry::SurfaceIndex& surface, const char* whose) {
    constexpr std::size_t least = 10;  // fewer do not say where the axis is
    if (!cylinder || points.size() < least) return;
    std::size_t outwards = 0;
    for (const auto& p : points) {
        const auto& t = surface.triangles()[surface.closest(p).triangle];
        const auto at = surface.vertices_mm();
        const Vector normal = (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]);
        outwards += normal.dot(away_from_axis(*cylinder, p)) >= 0 ? 1 : 0;
    }
    if (4 * outwards >= points.size()) return;
    throw InputError(
        fmt::format("{} is turned inside out: at {} of {} points its faces look into the head; turn the "
                    "order of their corners round (MeshLab: Invert Faces Orientation)",
                    whose, points.size() - outwards, points.size()));
}

/// Every point of a list has to lie on its surface. @param whose  "the reference", "the target"
void check_on_surface(const Landmarks& marks, const geometry::SurfaceIndex& surface, double most_off_mm,
                      const char* whose) {
    const geometry::Landmark* worst = nullptr;
    double worst_mm = most_off_mm;
    std::size_t off = 0;
    for (const auto& mark : marks.all()) {
        const double mm = surface.closest(mark.position_mm).distance_mm;
        off += mm > most_off_mm ? 1 : 0;
        if (mm > worst_mm) {
            worst_mm = mm;
            worst = &mark;
        }
    }
    if (worst)
        throw InputError(fmt::format(
            "{} off {} (of {}): '{}' by {:.1f} mm, and {:g} is the most; place it on this mesh, "
            "or mend its unit or frame",
            base::counted(off, "point lies", "points lie"), whose, marks.size(), worst->name, worst_mm, most_off_mm));
}

/// @throws InputError where a point is called as no label.
void check_names(const Landmarks& points, const Landmarks& labels) {
    std::vector<std::string> unknown, names;
    for (const auto& point : points.all())
        if (!labels.find(point.name)) unknown.push_back(fmt::format("'{}'", point.name));
    if (unknown.empty()) return;
    for (const auto& label : labels.all()) names.push_back(label.name);
    throw InputError(
        fmt::format("the reference has no label {}; there are: {}", fmt::join(unknown, ", "), fmt::join(names, ", ")));
}

/// The reference's +y on the target: the points say how it was turned.
Vector up_on_target(std::span<const Point> from, std::span<const Point> to) {
    const auto turned = geometry::rigid_fit(from, to);
    return turned ? Vector(turned->linear() * Vector::UnitY()) : Vector(Vector::UnitY());
}

}  // namespace

const char* to_string(LabelFitRest rest) { return rest == LabelFitRest::warped ? "warped" : "reference"; }

void LabelFitOptions::check() const {
    basis.check();
    energy.check();
    minimise.check();
    for (const auto& [name, value] :
         {std::pair{"most_off_mm", most_off_mm}, std::pair{"most_projected_mm", most_projected_mm}})
        if (!(value >= 0 && value <= 1e6)) throw InputError(fmt::format("{} is {}; give 0 to 1000000", name, value));
}

Landmarks LabelStart::labels() const {
    std::vector<geometry::Landmark> list;
    for (std::size_t k = 0; k < names.size(); ++k) list.push_back({names[k], start_mm[k], ""});
    return Landmarks(std::move(list));
}

void check_reference(const geometry::SurfaceIndex& reference, const Landmarks& labels, const LabelFitOptions& options) {
    check_on_surface(labels, reference, options.most_off_mm, "the reference");
    std::vector<Point> points;
    for (const auto& label : labels.all()) points.push_back(label.position_mm);
    check_winding(head_cylinder(points, Vector::UnitY()), points, reference, "the reference");
}

LabelStart start_labels(const geometry::SurfaceIndex& reference, const Landmarks& labels,
                        const geometry::SurfaceIndex& target, const Landmarks& points, const LabelFitOptions& options) {
    options.check();
    check_names(points, labels);
    constexpr std::size_t least = 4, enough = 10;  // an affine map; the paper: "10 or 12 markers"
    if (points.size() < least)
        throw InputError(
            fmt::format("{} placed by hand; {} are the least that say a map, and {} to 12 are well: place "
                        "more, all over the face",
                        base::counted(points.size(), "point is", "points are"), least, enough));
    check_reference(reference, labels, options);
    check_on_surface(points, target, options.most_off_mm, "the target");
    std::vector<Point> from, to;
    std::vector<std::string> paired;
    for (const auto& point : points.all()) {
        from.push_back(labels.position_mm(point.name));
        to.push_back(target.closest(point.position_mm).position_mm);
        paired.push_back(point.name);
    }
    check_sizes(from, to);
    LabelStart start{geometry::RadialBasisMap::fit(from, to, options.basis, paired), {}, {}, {}, {}, 0, {}};
    if (points.size() < enough)
        start.remarks.push_back(fmt::format("{} placed by hand; {} to 12 all over the face fit better",
                                            base::counted(points.size(), "point is", "points are"), enough));
    for (const auto& label : labels.all()) {
        start.names.push_back(label.name);
        start.warped_mm.push_back(start.target_from_reference(label.position_mm));
    }
    const auto cylinder = head_cylinder(start.warped_mm, up_on_target(from, to));
    check_winding(cylinder, start.warped_mm, target, "the target");
    for (std::size_t k = 0; k < start.names.size(); ++k) {
        const auto* point = points.find(start.names[k]);
        start.by_hand.push_back(point ? 1 : 0);
        std::optional<geometry::SurfacePoint> hit;
        if (!point && cylinder)
            hit = project_from_axis(*cylinder, start.warped_mm[k], target, options.most_projected_mm);
        start.projected += hit ? 1 : 0;
        if (!hit) hit = target.closest(point ? point->position_mm : start.warped_mm[k]);
        start.start_mm.push_back(hit->position_mm);
    }
    return start;
}

FittedLabels fit_labels(const LabelStart& start, const Landmarks& reference_labels,
                        const geometry::SurfaceIndex& target, const MarkerSet& set, SurfaceMinimiser minimiser,
                        const LabelFitOptions& options) {
    options.check();
    const auto surface = control_surface(set, start.names);
    // Corners of triangles alone: other labels have nothing that holds them.
    std::map<std::uint32_t, std::uint32_t> place;
    for (const auto& t : surface.triangles)
        for (const auto corner : t) place.emplace(corner, 0);
    std::vector<std::uint32_t> corners;
    for (auto& [corner, number] : place) {
        number = static_cast<std::uint32_t>(corners.size());
        corners.push_back(corner);
    }
    std::vector<geometry::Triangle> triangles;
    for (const auto& t : surface.triangles) triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    std::vector<Point> rest, begin;
    std::vector<std::uint8_t> holding;
    FittedLabels result;
    for (const auto corner : corners) {
        result.corners.push_back(start.names[corner]);
        rest.push_back(options.rest == LabelFitRest::warped ? start.warped_mm[corner]
                                                            : reference_labels.position_mm(start.names[corner]));
        begin.push_back(start.start_mm[corner]);
        holding.push_back(start.by_hand[corner]);
    }
    const SurfaceEnergy energy(rest, triangles, target, options.energy);
    result.found = minimise_surface(energy, begin, holding, minimiser, options.minimise);
    auto at_mm = start.start_mm;
    for (std::size_t k = 0; k < corners.size(); ++k)
        at_mm[corners[k]] = target.closest(result.found.pose_mm[k]).position_mm;
    std::vector<geometry::Landmark> list;
    for (std::size_t k = 0; k < at_mm.size(); ++k) list.push_back({start.names[k], at_mm[k], ""});
    result.labels = Landmarks(std::move(list));
    return result;
}

}  // namespace mimik::capture
