#include "modeling/control_points.h"

#include <fmt/format.h>

#include "geometry/surface_index.h"
#include "report/drawn_face.h"
#include "report/named_figure.h"

// Chapters 5.5 and 5.6.1 of the thesis: control points on a face, and carried over to others.

namespace mimik::report::thesis_figures {
namespace {

/// The catalogue's points of an expression on a neutral face.
std::vector<ShownControl> placed(const FigureCast& cast, const preprocessing::Face& face,
                                 const facs::Expression& expression) {
    // Points are placed in the frame of the average face, whose axes the catalogue means.
    auto grid = face.grid;
    for (auto& p : grid.vertices_mm) p = face.average_from_scan * p;
    const geometry::SurfaceIndex surface(grid.vertices_mm, geometry::triangles(grid));
    const auto marks = geometry::transformed(face.landmarks, face.average_from_scan);
    const auto placed =
        modeling::place_controls(cast.catalogue(), expression, marks, surface, {.coverage = false, .anchors = false});
    const geometry::Transform back = face.average_from_scan.inverse();
    std::vector<ShownControl> shown;
    for (const auto& point : placed.controls) shown.push_back({point.name, point.kind, back * point.position_mm});
    return shown;
}

/// Some control points lie on landmarks: their balls are the greater ones, so that none is hidden.
void add_markers(figures::Panel& panel, const geometry::Landmarks& landmarks,
                 const std::vector<ShownControl>& controls) {
    constexpr double landmark_radius_mm = 1.4, control_radius_mm = 2.2;
    panel.markers.push_back(landmark_markers(landmarks));
    panel.markers.back().radius_mm = landmark_radius_mm;
    for (auto& set : control_markers(controls)) {
        set.radius_mm = control_radius_mm;
        panel.markers.push_back(std::move(set));
    }
}

FigurePlan muscle_points(const FigureCast& cast) {
    const auto face = cast.neutral(cast.source());
    FigurePlan plan;
    plan.picture = page_of(4, "Muscle control points");
    for (const auto& code : thesis_codes()) {
        if (code == "12L") continue;
        const auto expression = cast.expression(code);
        auto panel = face_panel(drawn_surface(face.grid, cast.options().holes), middle_of(face), expression.name());
        auto controls = placed(cast, face, expression);
        std::erase_if(controls, [](const auto& control) { return control.kind != facs::ControlKind::muscle; });
        add_markers(panel, face.landmarks, controls);
        plan.picture.panels.push_back(std::move(panel));
    }
    letter_panels(plan.picture);
    plan.caption = fmt::format(
        "The positions of the muscle control points of each AU (red) and the landmarks (blue) on "
        "{}.",
        cast.words(cast.source()));
    return plan;
}

FigurePlan points_of_brow_lowerer(const FigureCast& cast) {
    const auto expression = cast.expression("4");
    FigurePlan plan;
    plan.picture = page_of(2, fmt::format("Control points of {}", cast.words(expression)));
    for (const auto& subject : {cast.male(), cast.female()}) {
        const auto face = cast.neutral(subject);
        auto panel = face_panel(drawn_surface(face.grid, cast.options().holes), middle_of(face), cast.words(subject));
        panel.markers = control_markers(placed(cast, face, expression));
        plan.picture.panels.push_back(std::move(panel));
    }
    letter_panels(plan.picture);
    plan.caption = fmt::format("Muscle (red) and wrinkle (orange) control points of {} marked on {} and {}.",
                               cast.words(expression), cast.words(cast.male()), cast.words(cast.female()));
    return plan;
}

FigurePlan to_expressive_face(const FigureCast& cast) {
    const auto expression = cast.expression("4");
    const auto source = cast.source_of(expression);
    const auto pair = cast.compared(cast.request(source, cast.female(), expression));
    const auto& person = *pair.source;
    FigurePlan plan;
    plan.picture = page_of(2, fmt::format("Control points of {}, followed", cast.words(expression)));
    auto first = neutral_panel(person, cast.options().holes, "Neutral source face " + source);
    add_markers(first, person.neutral.landmarks, person.controls);
    auto second = real_panel(person, cast.options().holes, "Expressive source face " + source);
    if (person.real)
        add_markers(second, geometry::transformed(person.real->landmarks, person.real->neutral_from_scan),
                    person.real_controls);
    plan.picture.panels = {std::move(first), std::move(second)};
    letter_panels(plan.picture);
    plan.caption = fmt::format(
        "Transferring the control points of {} from the neutral (left) to the expressive (right) "
        "source face of {} by the landmarks (blue).",
        cast.words(expression), source);
    return plan;
}

FigurePlan to_targets(const FigureCast& cast) {
    const auto expression = cast.expression("4");
    const auto source = cast.source_of(expression);
    FigurePlan plan;
    plan.picture = page_of(3, fmt::format("Control points of {} carried to target faces", cast.words(expression)));
    for (const auto& target : {cast.female(), cast.male()}) {
        const auto pair = cast.compared(cast.request(source, target, expression));
        if (plan.picture.panels.empty()) {
            plan.picture.panels.push_back(neutral_panel(*pair.source, cast.options().holes, "Source face " + source));
            add_markers(plan.picture.panels.back(), pair.source->neutral.landmarks, pair.source->controls);
        }
        plan.picture.panels.push_back(
            neutral_panel(*pair.target, cast.options().holes, "Target face " + cast.words(target)));
        add_markers(plan.picture.panels.back(), pair.target->neutral.landmarks, pair.target->controls);
    }
    letter_panels(plan.picture);
    plan.caption = fmt::format(
        "Transferring the control points of {} from the source face {} (left) to {} (middle) and "
        "{} (right); landmarks blue.",
        cast.words(expression), source, cast.words(cast.female()), cast.words(cast.male()));
    return plan;
}

}  // namespace

std::vector<NamedFigure> control_points_figures() {
    return {{"5-8", "Muscle control points of each AU", "a neutral scan", FigureNeeds::faces, muscle_points},
            {"5-9", "Muscle and wrinkle control points of AU4 on two faces", "two neutral scans", FigureNeeds::faces,
             points_of_brow_lowerer},
            {"5-10", "Control points of AU4 from the neutral to the expressive source face", "a scan of AU4",
             FigureNeeds::faces, to_expressive_face},
            {"5-11", "Control points of AU4 from a source to two targets", "a scan of AU4", FigureNeeds::faces,
             to_targets}};
}

}  // namespace mimik::report::thesis_figures
