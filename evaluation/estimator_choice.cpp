#include "evaluation/estimator_choice.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"

namespace mimik::evaluation {
namespace {

constexpr std::array alignments = {Alignment::given, Alignment::none, Alignment::landmarks, Alignment::stable_region};

const char* to_string(Correspondence correspondence) {
    switch (correspondence) {
        case Correspondence::closest_point:
            return "closest-point";
        case Correspondence::along_normal:
            return "along-normal";
        case Correspondence::registered:
            return "registered";
        case Correspondence::truth:
            break;
    }
    return "true";
}

const char* to_string(Distance distance) {
    switch (distance) {
        case Distance::point_to_surface:
            return "point-to-surface";
        case Distance::point_to_point:
            return "point-to-point";
        case Distance::along_normal:
            return "signed";
        case Distance::normal_angle:
            return "normal-angle";
        case Distance::curvature:
            break;
    }
    return "curvature";
}

/// "the nearest point q of the real surface", what a definition says of a correspondence.
const char* place_of(Correspondence correspondence) {
    switch (correspondence) {
        case Correspondence::closest_point:
            return "q is the nearest point of the real surface";
        case Correspondence::along_normal:
            return "q is where the vertex's own normal meets the real surface, at most 10 mm off; a vertex without a "
                   "hit is left out";
        case Correspondence::registered:
            return "q is where the template, bent on to both of the target's scans by landmarks and surface, says that "
                   "the vertex's skin went; a vertex off the template is left out";
        case Correspondence::truth:
            break;
    }
    return "q is where the vertex's skin truly went";
}

const char* blindness_of(Correspondence correspondence) {
    switch (correspondence) {
        case Correspondence::closest_point:
            return "skin that slides along the surface; a surface that the other face lacks";
        case Correspondence::along_normal:
            return "skin that slides along the surface; vertices whose normal meets nothing";
        case Correspondence::registered:
            return "what the registration gets wrong, and shares with methods that learn by it";
        case Correspondence::truth:
            break;
    }
    return "nothing, but needs a synthetic database";
}

EstimatorDefinition define(std::string name, Correspondence correspondence, Distance distance) {
    EstimatorDefinition made;
    made.choice = {Alignment::given, correspondence, distance, Direction::to_real};
    made.spelled = fmt::format("{}/{}", to_string(correspondence), to_string(distance));
    made.name = name.empty() ? made.spelled : std::move(name);
    made.unit = distance == Distance::normal_angle ? "deg" : distance == Distance::curvature ? "1/m" : "mm";
    made.metric = distance == Distance::along_normal ? "mean_absolute" : "mean";
    const bool vertex = correspondence == Correspondence::closest_point && distance == Distance::point_to_point;
    const char* place = vertex ? "q is the nearest vertex of the real scan" : place_of(correspondence);
    const char* what = "|p - q|";
    if (distance == Distance::along_normal)
        what = "(p - q) . n(q), n the real surface's outward normal; positive: the synthetic face lies outside";
    if (distance == Distance::normal_angle)
        what = "the angle between the synthetic face's normal at p and the real's at q";
    if (distance == Distance::curvature)
        what = "|H(p) - H(q)|, H the mean curvature of a quadric fitted to the vertices within 5 mm";
    made.definition = fmt::format("{}, p a vertex of the synthetic face; {}", what, place);
    made.blind_to = blindness_of(correspondence);
    if (distance == Distance::normal_angle) made.blind_to += "; shifts that turn no normal";
    if (distance == Distance::curvature) made.blind_to += "; shifts and turns; details below 5 mm";
    return made;
}

std::vector<EstimatorDefinition> define_all() {
    using C = Correspondence;
    using D = Distance;
    std::vector<EstimatorDefinition> all = {define("point-to-surface", C::closest_point, D::point_to_surface),
                                            define("point-to-point", C::closest_point, D::point_to_point),
                                            define("signed", C::closest_point, D::along_normal),
                                            define("normal-angle", C::closest_point, D::normal_angle),
                                            define("curvature", C::closest_point, D::curvature),
                                            define("along-normal", C::along_normal, D::point_to_surface),
                                            define("", C::along_normal, D::along_normal),
                                            define("", C::along_normal, D::normal_angle),
                                            define("", C::along_normal, D::curvature),
                                            define("registered", C::registered, D::point_to_point),
                                            define("", C::registered, D::along_normal),
                                            define("", C::registered, D::normal_angle),
                                            define("", C::registered, D::curvature),
                                            define("true", C::truth, D::point_to_point),
                                            define("", C::truth, D::along_normal),
                                            define("", C::truth, D::normal_angle),
                                            define("", C::truth, D::curvature)};
    auto reverse = define("reverse", C::closest_point, D::point_to_surface);
    reverse.choice.direction = Direction::to_synthetic;
    reverse.spelled = "reverse/" + reverse.spelled;
    reverse.definition = "|p - q|, p a vertex of the real scan; q is the nearest point of the synthetic face";
    reverse.blind_to = "skin that slides along the surface; a surface that the real scan lacks";
    all.push_back(reverse);
    auto hausdorff = define("hausdorff", C::closest_point, D::point_to_surface);
    hausdorff.choice.direction = Direction::larger_of_both;
    hausdorff.spelled = "hausdorff/" + hausdorff.spelled;
    hausdorff.metric = "max";
    hausdorff.definition =
        "the larger of the largest |p - q| of point-to-surface and of reverse; p95: of their 95th percentiles";
    hausdorff.blind_to = "skin that slides along the surface; how much of the face is off: one vertex decides";
    all.push_back(hausdorff);
    return all;
}

}  // namespace

const char* to_string(Alignment alignment) {
    switch (alignment) {
        case Alignment::none:
            return "none";
        case Alignment::landmarks:
            return "landmarks";
        case Alignment::stable_region:
            return "stable-region";
        case Alignment::given:
            break;
    }
    return "given";
}

std::vector<std::string> known_alignments() {
    std::vector<std::string> names;
    for (const auto alignment : alignments) names.emplace_back(to_string(alignment));
    return names;
}

Alignment alignment_by_name(const std::string& name) {
    for (const auto alignment : alignments)
        if (name == to_string(alignment)) return alignment;
    throw InputError(
        fmt::format("alignment '{}' is unknown; there are: {}", name, fmt::join(known_alignments(), ", ")));
}

std::span<const EstimatorDefinition> estimator_definitions() {
    static const auto all = define_all();
    return all;
}

const EstimatorDefinition& definition_of(const EstimatorChoice& choice) {
    auto given = choice;
    given.alignment = Alignment::given;
    for (const auto& one : estimator_definitions())
        if (one.choice == given) return one;
    throw InputError(fmt::format("no estimator measures {} by {}; 'mimik help estimators' lists those there are",
                                 to_string(choice.distance), to_string(choice.correspondence)));
}

std::string to_string(const EstimatorChoice& choice) {
    const auto& name = definition_of(choice).name;
    return choice.alignment == Alignment::given ? name : fmt::format("{}/{}", to_string(choice.alignment), name);
}

std::vector<std::string> known_estimator_names() {
    std::vector<std::string> names;
    for (const auto& one : estimator_definitions()) names.push_back(one.name);
    return names;
}

EstimatorChoice estimator_by_name(const std::string& name) {
    std::string_view rest = name;
    auto alignment = Alignment::given;
    for (const auto one : alignments) {
        const auto prefix = fmt::format("{}/", to_string(one));
        if (!rest.starts_with(prefix)) continue;
        alignment = one;
        rest.remove_prefix(prefix.size());
        break;
    }
    for (const auto& one : estimator_definitions()) {
        if (rest != one.name && rest != one.spelled) continue;
        auto choice = one.choice;
        choice.alignment = alignment;
        return choice;
    }
    throw InputError(fmt::format(
        "estimator '{}' is unknown; there are: {}; each may have an alignment before it ({}), as landmarks/signed",
        name, fmt::join(known_estimator_names(), ", "), fmt::join(known_alignments(), ", ")));
}

}  // namespace mimik::evaluation
