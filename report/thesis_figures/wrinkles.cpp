#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"
#include "report/drawn_face.h"
#include "report/named_figure.h"
#include "report/surface_profile.h"
#include "report/svg_plot.h"

// What the thesis does not have: cuts through a wrinkle, of the neutral face, the animated one and the real scan.

namespace mimik::report::thesis_figures {
namespace {

using geometry::Landmarks;
using geometry::Point;

/// Across the lines between the brows, from one to the other, a little above their inner ends.
CutLine brow_cut(const Landmarks& marks) {
    const Point left = marks.position_mm("brow_inner_left"), right = marks.position_mm("brow_inner_right");
    const Point middle = 0.5 * (left + right), half = 1.1 * (left - right);
    return {{middle.x() - half.x(), middle.y() - half.y() + 1}, {middle.x() + half.x(), middle.y() + half.y() + 1}};
}

/// Across the left nasolabial fold, at right angles to the line from the nose wing to the mouth corner.
CutLine nasolabial_cut(const Landmarks& marks) {
    const Point wing = marks.position_mm("nose_wing_left"), corner = marks.position_mm("mouth_corner_left");
    const Point middle = 0.5 * (wing + corner);
    const double dx = corner.x() - wing.x(), dy = corner.y() - wing.y(), length = std::hypot(dx, dy);
    const double out_x = -dy / length, out_y = dx / length;  // towards the cheek
    constexpr double inward_mm = 8, outward_mm = 32;
    return {{middle.x() - inward_mm * out_x, middle.y() - inward_mm * out_y},
            {middle.x() + outward_mm * out_x, middle.y() + outward_mm * out_y}};
}

/// Heights over the straight line between the ends of the neutral face's profile: what is shared by all is taken away.
void take_away_slope(std::vector<ProfilePoint>& profile, const std::vector<ProfilePoint>& neutral) {
    const ProfilePoint *first = nullptr, *last = nullptr;
    for (const auto& point : neutral) {
        if (!std::isfinite(point[1])) continue;
        if (!first) first = &point;
        last = &point;
    }
    if (!first || last == first) return;
    const double slope = ((*last)[1] - (*first)[1]) / ((*last)[0] - (*first)[0]);
    for (auto& point : profile) point[1] -= (*first)[1] + slope * (point[0] - (*first)[0]);
}

LinePlot profiles_of(const FigureCast& cast, const ShownPerson& person, CutLine (*cut)(const Landmarks&),
                     const std::string& title) {
    const auto line = cut(person.neutral.landmarks);
    const auto neutral = surface_profile(drawn_surface(person.neutral.grid, HoleDrawing::fill), line);
    auto shown = neutral;
    take_away_slope(shown, neutral);
    LinePlot plot{title, "along the cut, mm", "height, mm", {}};
    plot.lines.push_back({"neutral", shown, plot_colour(6), true});
    auto animated = surface_profile(drawn_animation(person.animated, person.neutral, HoleDrawing::fill), line);
    take_away_slope(animated, neutral);
    plot.lines.push_back({"animated", animated, plot_colour(1), false});
    if (person.real) {
        auto real =
            surface_profile(drawn_surface(person.real->grid, HoleDrawing::fill, person.real->neutral_from_scan), line);
        take_away_slope(real, neutral);
        plot.lines.push_back({cast.scan_words(), real, plot_colour(0), false});
    }
    return plot;
}

FigurePlan profile(const FigureCast& cast, const std::string& code, CutLine (*cut)(const Landmarks&),
                   const std::string& where) {
    const auto expression = cast.expression(code);
    const auto source = cast.source_of(expression);
    std::vector<LinePlot> plots;
    const auto first = cast.compared(cast.request(source, cast.female(), expression));
    plots.push_back(profiles_of(cast, *first.source, cut, fmt::format("{}, source {}", expression.name(), source)));
    plots.push_back(
        profiles_of(cast, *first.target, cut, fmt::format("{} on {}", expression.name(), cast.words(cast.female()))));
    if (cast.male() != cast.female()) {
        const auto second = cast.compared(cast.request(source, cast.male(), expression));
        plots.push_back(profiles_of(cast, *second.target, cut,
                                    fmt::format("{} on {}", expression.name(), cast.words(cast.male()))));
    }
    FigurePlan plan;
    plan.svg = line_plots_svg(plots);
    plan.caption = fmt::format(
        "A cut {} with {}: neutral, animated (method '{}') and {}. Height over the straight "
        "line between the ends of the neutral profile; each plot has its own scale.",
        where, cast.words(expression), cast.options().method, cast.scan_words());
    return plan;
}

}  // namespace

std::vector<NamedFigure> wrinkles_figures() {
    return {{"wrinkle-brow", "A cut through the lines between the brows, AU4", "a scan of AU4", FigureNeeds::faces,
             [](const FigureCast& cast) { return profile(cast, "4", brow_cut, "between the brows"); }},
            {"wrinkle-nasolabial", "A cut through the left nasolabial fold, AU12", "a scan of AU12", FigureNeeds::faces,
             [](const FigureCast& cast) {
                 return profile(cast, "12", nasolabial_cut, "across the left nasolabial fold");
             }}};
}

}  // namespace mimik::report::thesis_figures
