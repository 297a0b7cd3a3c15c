#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "report/drawn_face.h"
#include "report/named_figure.h"

// Chapter 5.3 of the thesis: what a database of faces holds.

namespace mimik::report::thesis_figures {
namespace {

/// A face of a subject in the frame of its neutral scan, with its photograph where it has one.
figures::Panel photographed(const FigureCast& cast, const preprocessing::Face& face, const geometry::Point& centre_mm,
                            std::string caption, std::vector<std::string>& remarks) {
    auto panel = face_panel(drawn_surface(face.grid, cast.options().holes, face.neutral_from_scan), centre_mm,
                            std::move(caption));
    if (const auto reason = add_photograph(panel, face); !reason.empty())
        remarks.push_back(reason);
    else
        darken_open_mouth(*panel.texture, face);
    return panel;
}

/// Databases list landmarks in orders of their own; numbers that are the same on every face need one.
geometry::Landmarks in_usual_order(const geometry::Landmarks& landmarks) {
    std::vector<geometry::Landmark> ordered;
    for (const auto name : geometry::standard_landmark_names())
        if (const auto* mark = landmarks.find(name)) ordered.push_back(*mark);
    const auto names = geometry::standard_landmark_names();
    for (const auto& mark : landmarks.all())
        if (std::find(names.begin(), names.end(), mark.name) == names.end()) ordered.push_back(mark);
    return geometry::Landmarks(std::move(ordered));
}

FigurePlan landmarks(const FigureCast& cast) {
    const auto face = cast.neutral(cast.source());
    FigurePlan plan;
    plan.picture = page_of(1, {});
    plan.picture.panel_width_px = 900;
    plan.picture.panel_height_px = 1080;
    auto panel = photographed(cast, face, middle_of(face), {}, plan.remarks);
    const auto marks = in_usual_order(face.landmarks);
    auto set = landmark_markers(marks);
    set.numbered = true;
    set.radius_mm = 1.6;
    panel.markers.push_back(std::move(set));
    plan.picture.panels.push_back(std::move(panel));
    plan.caption = fmt::format("The facial landmarks of {}, by number:", cast.words(cast.source()));
    int number = 0;
    for (const auto& mark : marks.all())
        plan.caption += fmt::format("{} {} {}", number == 0 ? "" : ",", number + 1, mark.name), ++number;
    plan.caption += ". Left and right are the subject's own.";
    return plan;
}

/// Everything that a subject was scanned with, once each, in the order of the workspace.
std::vector<facs::Expression> scanned_units(const preprocessing::Workspace& workspace, const std::string& subject) {
    std::vector<facs::Expression> expressions;
    for (const auto& id : workspace.scans()) {
        if (id.subject != subject || id.neutral()) continue;
        const auto expression = id.expression();
        if (expression.units().empty() || !facs::group_holds_units(expression.group())) continue;
        if (std::find(expressions.begin(), expressions.end(), expression) == expressions.end())
            expressions.push_back(expression);
    }
    return expressions;
}

FigurePlan action_units(const FigureCast& cast) {
    const auto expressions = scanned_units(cast.workspace(), cast.source());
    if (expressions.empty()) throw InputError(cast.source() + " was scanned with no Action Unit");
    std::vector<facs::Expression> upper, lower;
    for (const auto& expression : expressions) (expression.group() == "UFAU" ? upper : lower).push_back(expression);
    const auto neutral = cast.neutral(cast.source());
    const auto centre_mm = middle_of(neutral);
    constexpr std::size_t columns = 7;
    FigurePlan plan;
    plan.picture = page_of(columns, "Action Units of the upper face, then of the lower face");
    plan.picture.font_size_px = 18;
    const auto add = [&](const std::vector<facs::Expression>& units) {
        for (const auto& expression : units)
            plan.picture.panels.push_back(photographed(cast, cast.scan(cast.source(), expression), centre_mm,
                                                       cast.words(expression), plan.remarks));
        while (plan.picture.panels.size() % columns != 0) plan.picture.panels.emplace_back();
    };
    add(upper);
    add(lower);
    while (!plan.picture.panels.empty() && plan.picture.panels.back().mesh.vertices_mm.empty())
        plan.picture.panels.pop_back();
    plan.caption = fmt::format("Upper face and lower face Action Units of {} in the database: {} scans.",
                               cast.words(cast.source()), upper.size() + lower.size());
    if (plan.remarks.size() > 1) plan.remarks = {cast.source() + " has no photographs: the scans are shown plain"};
    return plan;
}

FigurePlan average_face(const FigureCast& cast) {
    const auto& average = cast.workspace().average();
    FigurePlan plan;
    plan.picture = page_of(3, "The average face");
    const auto mesh = largest_part(drawn_surface(average.grid, HoleDrawing::fill));
    for (const auto& [view, words] :
         {std::pair("front", "front"), std::pair("three-quarter-left", "three-quarter view"),
          std::pair("left", "profile from the subject's left")}) {
        auto panel = face_panel(mesh, geometry::Point::Zero(), words);
        panel.centre_mm.reset();
        panel.view = figures::parse_view(view);
        plan.picture.panels.push_back(std::move(panel));
    }
    letter_panels(plan.picture);
    plan.caption =
        fmt::format("The average face model (AFM) of the {} neutral faces of the workspace.", average.scans.size());
    return plan;
}

}  // namespace

std::vector<NamedFigure> database_figures() {
    return {{"5-2", "Facial landmarks", "a neutral scan; its photograph, if any", FigureNeeds::faces, landmarks},
            {"5-3", "Upper and lower face Action Units of the database", "scans of AUs; their photographs, if any",
             FigureNeeds::faces, action_units},
            {"5-4", "The average face model", "the workspace", FigureNeeds::faces, average_face}};
}

}  // namespace mimik::report::thesis_figures
