#include "animation/dense_label_fit.h"

#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.h"
#include "geometry/surface_index.h"
#include "geometry/weld.h"

namespace mimik::animation {

using geometry::Point;
using geometry::Triangle;

namespace {

struct Part {
    std::vector<Point> vertices_mm;
    std::vector<Triangle> triangles;
};

/// What of a mesh lies about the labels, in one piece where textures split it.
Part about_labels(std::span<const Point> vertices_mm, std::span<const Triangle> triangles,
                  const std::vector<Point>& labels_mm, double around_mm) {
    const auto welded = geometry::weld(vertices_mm, triangles);
    const auto near = [&](const Point& p) {
        for (const auto& label : labels_mm)
            if ((p - label).squaredNorm() <= around_mm * around_mm) return true;
        return false;
    };
    constexpr std::uint32_t nowhere = 0xFFFFFFFF, unknown = 0xFFFFFFFE;
    std::vector<std::uint32_t> place(vertices_mm.size(), unknown);
    Part part;
    const auto place_of = [&](std::uint32_t v) {
        auto& at = place[welded[v]];
        if (at == unknown) {
            at = near(vertices_mm[v]) ? static_cast<std::uint32_t>(part.vertices_mm.size()) : nowhere;
            if (at != nowhere) part.vertices_mm.push_back(vertices_mm[v]);
        }
        return at;
    };
    for (const auto& t : triangles) {
        const Triangle moved = {place_of(t[0]), place_of(t[1]), place_of(t[2])};
        if (moved[0] != nowhere && moved[1] != nowhere && moved[2] != nowhere) part.triangles.push_back(moved);
    }
    return part;
}

/// A label's own triangle takes part, or one beside it.
void check_bound(const std::vector<geometry::SurfacePoint>& bound, const std::vector<std::string>& names,
                 const DenseLabelFitOptions& options) {
    constexpr double most_off_mm = 5;
    for (std::size_t k = 0; k < bound.size(); ++k)
        if (bound[k].distance_mm > most_off_mm)
            throw InputError(
                fmt::format("'{}' lies {:.1f} mm off the part of the reference within {:g} mm of the labels; the "
                            "triangles of the reference are too large, or it is off its mesh: take a finer mesh",
                            names[k], bound[k].distance_mm, options.around_mm));
}

}  // namespace

void DenseLabelFitOptions::check() const {
    fit.check();
    if (!(around_mm > 0)) throw InputError(fmt::format("around_mm is {}; give more than 0", around_mm));
    if (!(least_matched >= 0 && least_matched <= 1))
        throw InputError(fmt::format("least_matched is {}; give a share from 0 to 1", least_matched));
}

DenselyFittedLabels fit_labels_densely(const capture::LabelStart& start, std::span<const Point> reference_mm,
                                       std::span<const Triangle> reference_triangles,
                                       const geometry::Landmarks& reference_labels,
                                       const preprocessing::FitTarget& target, const DenseLabelFitOptions& options) {
    options.check();
    const auto begun = std::chrono::steady_clock::now();
    std::vector<Point> labels_mm;
    for (const auto& name : start.names) labels_mm.push_back(reference_labels.position_mm(name));
    const auto part = about_labels(reference_mm, reference_triangles, labels_mm, options.around_mm);
    const geometry::SurfaceIndex skin(part.vertices_mm, part.triangles);
    const auto bound = skin.closest(labels_mm);
    check_bound(bound, start.names, options);
    std::vector<preprocessing::FitMark> marks;
    for (std::size_t k = 0; k < bound.size(); ++k)
        if (start.by_hand[k] != 0)
            marks.push_back({part.triangles[bound[k].triangle], bound[k].barycentric, start.start_mm[k], 1.0});
    std::vector<Point> warped(part.vertices_mm.size());
    start.target_from_reference.apply(part.vertices_mm, warped);
    const auto fit =
        preprocessing::NonrigidFitter(part.vertices_mm, part.triangles).fit(warped, target, marks, options.fit);
    if (fit.matched_share < options.least_matched)
        throw NumericalError(
            fmt::format("{:.0f} % of the reference came to lie on the target, and {:.0f} % are the "
                        "least: place the points anew, or more of them, all over the face",
                        100 * fit.matched_share, 100 * options.least_matched));
    DenselyFittedLabels result;
    std::vector<geometry::Landmark> list;
    for (std::size_t k = 0; k < bound.size(); ++k) {
        Point at = start.start_mm[k];
        if (start.by_hand[k] == 0) {
            at = Point::Zero();
            const auto& corners = part.triangles[bound[k].triangle];
            for (std::size_t c = 0; c < 3; ++c)
                at += bound[k].barycentric[static_cast<Eigen::Index>(c)] * fit.vertices_mm[corners[c]];
            at = target.surface().closest(at).position_mm;
        }
        list.push_back({start.names[k], at, ""});
    }
    result.labels = geometry::Landmarks(std::move(list));
    result.vertices = part.vertices_mm.size();
    result.matched_share = fit.matched_share;
    result.residual_rms_mm = fit.residual_rms_mm;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return result;
}

}  // namespace mimik::animation
