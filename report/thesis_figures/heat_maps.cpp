#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "report/drawn_face.h"
#include "report/named_figure.h"

// What the thesis does not have: how far the animated faces lie from the scans, in colours that mean the same on every
// face.

namespace mimik::report::thesis_figures {
namespace {

/// Distances of an animated face, signed: positive where it lies before the real scan, as its normals see it. NaN,
/// drawn in grey, where none can be had.
std::vector<double> signed_distances(const geometry::Mesh& mesh, const std::vector<double>& distance_mm,
                                     const geometry::SurfaceIndex& real) {
    const auto normals = geometry::vertex_normals(mesh.vertices_mm, geometry::triangulate(mesh.faces));
    std::vector<double> signed_mm(distance_mm.size());
    for (std::size_t v = 0; v < signed_mm.size(); ++v) {
        signed_mm[v] = distance_mm[v];
        if (!std::isfinite(distance_mm[v])) continue;
        const geometry::Vector way = mesh.vertices_mm[v] - real.closest(mesh.vertices_mm[v]).position_mm;
        if (way.dot(normals[v]) < 0) signed_mm[v] = -distance_mm[v];
    }
    return signed_mm;
}

figures::Panel error_panel(const FigureCast& cast, const ShownPerson& person, const std::string& caption, bool sign) {
    figures::Panel panel;
    if (!person.scored) {
        panel.caption = fmt::format("{}\nnot scanned", caption);
        return panel;
    }
    std::vector<std::uint32_t> kept;
    // A mesh of its own, without the inside of a mouth: there is nothing to measure.
    panel = face_panel(drawn_animation(person.animated, person.neutral, cast.options().holes, &kept),
                       middle_of(person.neutral), caption);
    auto values = distance_attribute(*person.scored, moved_vertices(person.neutral.grid, person.animated), kept);
    values.values.resize(panel.mesh.vertices_mm.size(), std::numeric_limits<double>::quiet_NaN());
    if (sign) values.values = signed_distances(panel.mesh, values.values, *person.scored->expressive);
    panel.mesh.attributes = {std::move(values)};
    const double scale_mm = cast.options().error_scale_mm;
    panel.scalar = figures::Scalar{.attribute = "distance_mm",
                                   .label = sign ? "before (+), behind (-), mm" : "distance, mm",
                                   .range = std::array{sign ? -scale_mm : 0.0, scale_mm},
                                   .map = sign ? figures::ColourMap::diverging : figures::ColourMap::sequential};
    if (const auto& mean_mm = person.compared.face_mm) panel.caption += fmt::format("\nmean {:.2f} mm", *mean_mm);
    return panel;
}

FigurePlan error_map(const FigureCast& cast, bool sign) {
    FigurePlan plan;
    plan.picture = page_of(6, fmt::format("{} of the animated faces to the {}s", sign ? "Signed distance" : "Distance",
                                          cast.scan_words()));
    plan.picture.panel_width_px = 270;
    plan.picture.panel_height_px = 330;
    plan.picture.legend = false;
    std::string missing;
    for (const auto& code : thesis_codes()) {
        const auto expression = cast.expression(code);
        for (const auto& target : {cast.female(), cast.male()}) {
            try {
                const auto pair = cast.compared(cast.request(cast.source_of(expression), target, expression));
                plan.picture.panels.push_back(
                    error_panel(cast, *pair.target, fmt::format("{}, {}", expression.name(), target), sign));
            } catch (const InputError& e) {  // one of nine that is missing leaves a gap
                plan.picture.panels.emplace_back().caption = fmt::format("{}, {}\nnot made", expression.name(), target);
                const std::string reason = fmt::format("{}: {}", expression.name(), e.what());
                if (plan.remarks.empty() || plan.remarks.back() != reason) plan.remarks.push_back(reason);
            }
        }
    }
    const auto& panels = plan.picture.panels;
    if (std::none_of(panels.begin(), panels.end(), [](const auto& panel) { return panel.scalar.has_value(); }))
        throw InputError("no target was scanned with an expression that a source has");
    plan.caption = fmt::format(
        "Distance of every vertex of the animated faces to the {}, {}, method '{}', each AU on {} and {}. The "
        "colours mean the same on every face{}; grey: no data. The numbers are means over the face.",
        cast.scan_words(), sign ? "signed: red before it, blue behind it" : "mm", cast.options().method,
        cast.words(cast.female()), cast.words(cast.male()), sign ? ", white is 0" : "");
    return plan;
}

}  // namespace

std::vector<NamedFigure> heat_maps_figures() {
    return {{"heat-map", "Distance of the animated faces to the scans", "scans of the thesis's AUs", FigureNeeds::faces,
             [](const FigureCast& cast) { return error_map(cast, false); }},
            {"heat-map-signed", "The same, signed: before or behind the scan", "scans of the thesis's AUs",
             FigureNeeds::faces, [](const FigureCast& cast) { return error_map(cast, true); }}};
}

}  // namespace mimik::report::thesis_figures
