#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "animation/animate.h"
#include "base/errors.h"
#include "report/drawn_face.h"
#include "report/named_figure.h"

// Chapters 5.6, 6 and 7 of the thesis, and its appendix: faces that were animated, beside the scans of the same people.

namespace mimik::report::thesis_figures {
namespace {

std::string distance_words(const FigureCast& cast, const ShownPerson& person) {
    if (!person.scored) return {};
    const auto& c = person.compared;
    return fmt::format(
        " The animated {} lies {:.2f} mm from the {} in the zone of the expression; doing nothing {:.2f} mm{}.",
        c.subject, c.zone_mm, cast.scan_words(), c.zone_nothing_mm,
        c.zone_mm > c.zone_nothing_mm ? ": the animation is worse than doing nothing" : "");
}

/// Neutral, animated, real: three panels of one person.
void add_three(FigurePlan& plan, const FigureCast& cast, const ShownPerson& person, const std::string& who) {
    const auto holes = cast.options().holes;
    auto& panels = plan.picture.panels;
    panels.push_back(neutral_panel(person, holes, "Neutral " + who));
    panels.push_back(animated_panel(person, holes, "Animated " + who));
    panels.push_back(real_panel(person, holes, fmt::format("{} of the {}", cast.scan_title(), who)));
    if (!person.real) plan.remarks.push_back(panels.back().caption);
    plan.caption += distance_words(cast, person);
}

std::string method_words(const FigureCast& cast) { return fmt::format("method '{}'", cast.options().method); }

/// Figs 6-1 to 6-3 and 6-6, (d) to (i): source above, target below.
FigurePlan source_and_target(const FigureCast& cast, const std::string& code) {
    const auto expression = cast.expression(code);
    const auto source = cast.source_of(expression);
    const auto pair = cast.compared(cast.request(source, cast.female(), expression));
    FigurePlan plan;
    plan.picture = page_of(3, "Animation of " + cast.words(expression));
    plan.caption = fmt::format("Animation of {} by {}, {}: {} above, {} below.", cast.words(expression), source,
                               method_words(cast), source, cast.words(cast.female()));
    add_three(plan, cast, *pair.source, "source face " + source);
    add_three(plan, cast, *pair.target, "target face " + cast.female());
    letter_panels(plan.picture);
    return plan;
}

/// Figs, (d) to (l): source, female target, male target.
FigurePlan example_set(const FigureCast& cast, const std::string& code) {
    const auto expression = cast.expression(code);
    const auto source = cast.source_of(expression);
    FigurePlan plan;
    plan.picture = page_of(3, "Animation of " + cast.words(expression));
    plan.caption = fmt::format("Animation of {} by {}, {}: source, {}, {}.", cast.words(expression), source,
                               method_words(cast), cast.words(cast.female()), cast.words(cast.male()));
    const auto first = cast.compared(cast.request(source, cast.female(), expression));
    add_three(plan, cast, *first.source, "source face " + source);
    add_three(plan, cast, *first.target, "target face " + cast.female());
    if (cast.male() != cast.female()) {
        const auto second = cast.compared(cast.request(source, cast.male(), expression));
        add_three(plan, cast, *second.target, "target face " + cast.male());
    }
    letter_panels(plan.picture);
    return plan;
}

FigurePlan magnitudes(const FigureCast& cast) {
    FigurePlan plan;
    constexpr std::array steps = {0.0, 0.25, 0.5, 0.75, 1.0};
    plan.picture = page_of(static_cast<int>(steps.size()), "The magnitude m of an animation");
    plan.caption =
        fmt::format("Animation of {} and {} on {} by changing the magnitude m, {}.", cast.words(cast.expression("4")),
                    cast.words(cast.expression("12")), cast.words(cast.female()), method_words(cast));
    for (const auto* code : {"4", "12"}) {
        const auto expression = cast.expression(code);
        const auto pair = cast.compared(cast.request(cast.source_of(expression), cast.female(), expression));
        for (const double m : steps) {
            auto animated = pair.target->animated;  // the field is linear in m (Eqs 5.8 and 5.10)
            for (auto& way : animated.field.mm) way *= m;
            plan.picture.panels.push_back(
                face_panel(drawn_animation(animated, pair.target->neutral, cast.options().holes),
                           middle_of(pair.target->neutral), fmt::format("{}, m = {:g}", expression.name(), m)));
        }
    }
    letter_panels(plan.picture);
    return plan;
}

/// A request of a method by control points alone, in which wrinkle points make a difference.
ComparisonRequest by_points(const FigureCast& cast, const std::string& target, const facs::Expression& expression,
                            bool wrinkle_points) {
    auto request = cast.request(cast.source_of(expression), target, expression);
    if (request.model.correspondence == modeling::Correspondence::dense) {
        // The dense model follows every vertex and has no need of points: here they are the thing to see.
        request.method_name = "sparse";
        request.model = modeling::ModelOptions::sparse();
        request.model.coverage_points = false;
    }
    request.model.wrinkle_points = wrinkle_points;
    return request;
}

/// What wrinkle points change, mm per vertex: the eye alone hardly sees it.
figures::Panel difference_panel(const FigureCast& cast, const ShownPerson& without, const ShownPerson& with) {
    std::vector<std::uint32_t> kept;
    auto mesh = drawn_animation(with.animated, with.neutral, cast.options().holes, &kept);
    geometry::VertexAttribute change{"change_mm", 1, {}};
    for (const auto v : kept)
        change.values.push_back((with.animated.field.mm[v] - without.animated.field.mm[v]).norm());
    change.values.resize(mesh.vertices_mm.size(), std::numeric_limits<double>::quiet_NaN());
    mesh.attributes = {std::move(change)};
    auto panel = face_panel(std::move(mesh), middle_of(with.neutral), "what they change");
    panel.scalar = figures::Scalar{.attribute = "change_mm", .label = "change, mm"};
    return panel;
}

FigurePlan wrinkle_points(const FigureCast& cast) {
    const auto expression = cast.expression("4");
    FigurePlan plan;
    plan.picture = page_of(3, fmt::format("{} without and with wrinkle control points", cast.words(expression)));
    const auto request = by_points(cast, cast.female(), expression, true);
    const auto without = cast.compared(by_points(cast, cast.female(), expression, false));
    const auto with = cast.compared(request);
    const auto holes = cast.options().holes;
    plan.picture.panels = {animated_panel(*without.target, holes, "without wrinkle control points"),
                           animated_panel(*with.target, holes, "with wrinkle control points"),
                           difference_panel(cast, *without.target, *with.target)};
    letter_panels(plan.picture);
    plan.caption = fmt::format(
        "Animated {} with {} of {}, method '{}': muscle control points alone (a), wrinkle control points as well (b), "
        "and how far these move every vertex on (c).",
        cast.words(cast.female()), cast.words(expression), request.source, request.method_name);
    if (request.method_name != cast.options().method)
        plan.remarks.push_back("by control points alone (sparse): the default method follows every vertex");
    return plan;
}

/// The subject that moves most: an exaggerated expression.
ShownPair most_exaggerated(const FigureCast& cast, const facs::Expression& expression, const std::string& target) {
    const auto sources = cast.sources_of(expression);
    if (sources.empty()) throw InputError(fmt::format("nobody but the targets was scanned with {}", expression.name()));
    ShownPair most;
    double most_mm = -1;
    for (const auto& source : sources) {
        auto pair = cast.compared(cast.request(source, target, expression));
        const double moved_mm = pair.source->compared.zone_nothing_mm;
        if (moved_mm > most_mm) {
            most_mm = moved_mm;
            most = pair;
        }
    }
    return most;
}

FigurePlan exaggerated(const FigureCast& cast) {
    const auto expression = cast.expression("20");
    const auto pair = most_exaggerated(cast, expression, cast.male());
    const auto& source = pair.source->neutral.id.subject;
    const auto holes = cast.options().holes;
    FigurePlan plan;
    plan.picture = page_of(2, fmt::format("{} with an exaggerated expression", cast.words(expression)));
    plan.picture.panels = {neutral_panel(*pair.source, holes, "Neutral source face " + source),
                           real_panel(*pair.source, holes, fmt::format("{} of the source", cast.scan_title())),
                           neutral_panel(*pair.target, holes, "Neutral target face " + cast.male()),
                           animated_panel(*pair.target, holes, "Animated target face " + cast.male())};
    letter_panels(plan.picture);
    plan.caption = fmt::format("Animation of {} by the source who moves most, {} ({:.2f} mm in the zone), on {}, {}.",
                               cast.words(expression), source, pair.source->compared.zone_nothing_mm,
                               cast.words(cast.male()), method_words(cast)) +
                   distance_words(cast, *pair.target);
    return plan;
}

FigurePlan different_sources(const FigureCast& cast) {
    const auto expression = cast.expression("4");
    auto sources = cast.sources_of(expression);
    if (sources.empty()) throw InputError(fmt::format("nobody but the targets was scanned with {}", expression.name()));
    if (sources.size() > 3) sources.resize(3);
    FigurePlan plan;
    plan.picture = page_of(3, fmt::format("{} by different source faces", cast.words(expression)));
    plan.caption = fmt::format(
        "{} by different source faces: {}s of the sources on the left, animated target "
        "faces in the middle ({}) and on the right ({}), {}.",
        cast.words(expression), cast.scan_words(), cast.words(cast.female()), cast.words(cast.male()),
        method_words(cast));
    for (const auto& source : sources) {
        bool first = true;
        for (const auto& target : {cast.female(), cast.male()}) {
            const auto pair = cast.compared(cast.request(source, target, expression));
            if (first)
                plan.picture.panels.push_back(real_panel(*pair.source, cast.options().holes, "Source " + source));
            first = false;
            plan.picture.panels.push_back(
                animated_panel(*pair.target, cast.options().holes, fmt::format("{} on {}", source, target)));
        }
    }
    letter_panels(plan.picture);
    if (sources.size() < 2) plan.remarks.push_back("there is no second source with AU4 beside the two targets");
    return plan;
}

FigurePlan merged_emotion(const FigureCast& cast) {
    const auto brow = cast.expression("1"), mouth = cast.expression("15");
    const auto one = cast.compared(cast.request(cast.source_of(brow), cast.female(), brow));
    const auto other = cast.compared(cast.request(cast.source_of(mouth), cast.female(), mouth));
    const auto& neutral = one.target->neutral;
    auto merged = one.target->animated;
    auto& field = merged.field.mm;
    for (std::size_t v = 0; v < field.size(); ++v) field[v] += other.target->animated.field.mm[v];
    merged.lip_sides = other.target->animated.lip_sides;
    FigurePlan plan;
    plan.picture = page_of(4, "A sad face: AU1 and AU15 merged");
    const auto holes = cast.options().holes;
    plan.picture.panels = {neutral_panel(*one.target, holes, "Neutral face " + cast.female()),
                           animated_panel(*one.target, holes, cast.words(brow)),
                           animated_panel(*other.target, holes, cast.words(mouth)),
                           face_panel(drawn_animation(merged, neutral, holes), middle_of(neutral), "AU1 and AU15")};
    letter_panels(plan.picture);
    plan.caption = fmt::format(
        "A sad emotion created by merging {} of {} and {} of {} on {}, {}: the displacements "
        "add.",
        cast.words(brow), one.source->neutral.id.subject, cast.words(mouth), other.source->neutral.id.subject,
        cast.words(cast.female()), method_words(cast));
    return plan;
}

}  // namespace

std::vector<NamedFigure> animations_figures() {
    std::vector<NamedFigure> figures = {
        {"5-12", "AU4 and AU12 by changing the magnitude m", "scans of AU4 and AU12", FigureNeeds::faces, magnitudes},
        {"6-4", "An animated face without and with wrinkle control points", "a scan of AU4", FigureNeeds::faces,
         wrinkle_points},
        {"6-5", "AU20 with an exaggerated expression", "a scan of AU20", FigureNeeds::faces, exaggerated},
        {"7-1", "AU4 by different source faces", "scans of AU4, best of three sources", FigureNeeds::faces,
         different_sources},
        {"7-2", "A sad emotion by merging AU1 and AU15", "scans of AU1 and AU15", FigureNeeds::faces, merged_emotion}};
    const auto add = [&](const std::string& name, const std::string& code, bool both_targets) {
        const auto words = facs::builtin_catalogue().expression(code).name();
        figures.push_back({name, fmt::format("Animation of {}", words + (code == "12L" ? " (left side only)" : "")),
                           fmt::format("a scan of {}", words), FigureNeeds::faces,
                           [code, both_targets](const FigureCast& cast) {
                               return both_targets ? example_set(cast, code) : source_and_target(cast, code);
                           }});
    };
    add("6-1", "4", false);
    add("6-2", "12", false);
    add("6-3", "15", false);
    add("6-6", "12L", false);
    int number = 0;
    for (const auto& code : thesis_codes()) add(fmt::format("A-{}", ++number), code, true);
    return figures;
}

}  // namespace mimik::report::thesis_figures
