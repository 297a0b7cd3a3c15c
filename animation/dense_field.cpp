#include "animation/dense_field.h"

#include <memory>
#include <vector>

namespace mimik::animation {

using geometry::Point;
using geometry::Vector;
using modeling::Normalisation;
using preprocessing::KeptRegistrations;

namespace {

/// Where a vertex of a face lies on the template that was bent on to it.
struct TemplatePlace {
    std::uint32_t vertex = 0;
    geometry::Triangle corners = {0, 0, 0};
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();  ///< of the corners; they hold the fade beyond the rim
};
struct TemplatePlaces {
    std::vector<TemplatePlace> of_vertices;  ///< of those that move
    std::vector<preprocessing::LipSide> lip_sides;
};

/// 1 on the template, 0 beyond the fade, smooth between.
double faded(double beyond_mm) {
    if (beyond_mm >= rim_fade_mm) return 0.0;
    const double t = 1.0 - beyond_mm / rim_fade_mm;
    return t * t * (3.0 - 2.0 * t);
}

/// The template on the target, average frame: a scan's is kept with its workspace.
std::vector<Point> bent_on_to(const PreparedTarget& target, const KeptRegistrations& registrations) {
    if (const auto* face = target.face()) return registrations.neutral(*face).vertices_mm;
    const auto& normalised = target.normalised(Normalisation::similarity);
    const auto& surface = target.surface();
    std::vector<geometry::Triangle> measured;
    for (const auto& t : surface.triangles)
        if (surface.measured[t[0]] && surface.measured[t[1]] && surface.measured[t[2]]) measured.push_back(t);
    auto vertices = normalised.vertices_mm;
    for (std::size_t v = 0; v < surface.size(); ++v)
        if (!surface.present[v]) vertices[v] = Point::Zero();
    return registrations.registration()
        .neutral(preprocessing::FitTarget(vertices, measured), normalised.landmarks)
        .vertices_mm;
}

TemplatePlaces locate(const PreparedTarget& target, const KeptRegistrations& registrations) {
    const auto& vertices = target.normalised(Normalisation::similarity).vertices_mm;
    const auto& surface = target.surface();
    std::vector<Point> present;
    TemplatePlaces places;
    for (std::uint32_t v = 0; v < surface.size(); ++v) {
        if (!surface.present[v]) continue;
        places.of_vertices.emplace_back().vertex = v;
        present.push_back(vertices[v]);
    }
    const auto& face_template = registrations.face_template();
    const geometry::SurfaceIndex index(bent_on_to(target, registrations), face_template.surface.triangles);
    const auto hits = index.closest(present);
    const auto side_of = preprocessing::lip_sides(face_template);
    places.lip_sides.assign(surface.size(), preprocessing::LipSide::neither);
    for (std::size_t k = 0; k < hits.size(); ++k) {
        auto& place = places.of_vertices[k];
        place.corners = index.triangles()[hits[k].triangle];
        place.weights = hits[k].barycentric * (index.on_border(hits[k]) ? faded(hits[k].distance_mm) : 1.0);
        places.lip_sides[place.vertex] = side_of[hits[k].triangle];
    }
    std::erase_if(places.of_vertices, [](const TemplatePlace& place) { return place.weights.isZero(0); });
    return places;
}

/// Kept with the target, which outlives what is made of it here.
const TemplatePlaces& places_on(const PreparedTarget& target, const modeling::TemplateMotion& dense) {
    const auto kept = target.kept(dense.registrations, [&]() -> std::shared_ptr<const void> {
        return std::make_shared<const TemplatePlaces>(locate(target, *dense.registrations));
    });
    return *static_cast<const TemplatePlaces*>(kept.get());
}

}  // namespace

std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget& target, const modeling::TemplateMotion& dense) {
    return places_on(target, dense).lip_sides;
}

geometry::DisplacementField dense_field(const PreparedTarget& target, const modeling::TemplateMotion& dense) {
    const Eigen::Matrix3d target_from_average =
        target.average_from_target(Normalisation::similarity).linear().inverse();
    auto field = geometry::DisplacementField::still(target.surface().size());
    field.answered = target.surface().present;
    for (const auto& place : places_on(target, dense).of_vertices) {
        Vector motion = Vector::Zero();
        for (std::size_t c = 0; c < 3; ++c)
            motion += place.weights[static_cast<Eigen::Index>(c)] * dense.motion_mm[place.corners[c]];
        field.mm[place.vertex] = target_from_average * motion;
    }
    return field;
}

}  // namespace mimik::animation
