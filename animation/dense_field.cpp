#include "animation/dense_field.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "animation/inner_parts.h"
#include "animation/mesh_lips.h"
#include "animation/rim_motion.h"
#include "modeling/skin_turn.h"
#include "preprocessing/kept_registrations.h"

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
/// A vertex beyond the template's rim.
struct PlaceBeyondRim {
    std::uint32_t vertex = 0;
    std::vector<MotionShare> shares;  ///< they hold the fade
};
struct TemplatePlaces {
    std::vector<TemplatePlace> of_vertices;  ///< of those that move
    std::vector<PlaceBeyondRim> beyond_rim;  ///< likewise; no vertex is in both
    std::vector<preprocessing::LipSide> lip_sides;
    InnerParts inner;                       ///< of somebody's mesh; a scan has none
    std::vector<Point> bent_mm;             ///< the template on the target
    std::vector<Eigen::Quaterniond> turns;  ///< of its skin, from the template's own
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

/// @param hits  on the template, of the vertices at `moving`
InnerParts inner_parts_of(const PreparedTarget& target, const geometry::SurfaceIndex& index,
                          std::span<const TemplatePlace> moving, std::span<const geometry::SurfacePoint> hits) {
    const auto& normalised = target.normalised(Normalisation::similarity);
    std::vector<double> behind_mm(target.surface().size(), 0.0);
    for (std::size_t k = 0; k < hits.size(); ++k) {
        const auto& corners = index.triangles()[hits[k].triangle];
        const auto& bent = index.vertices_mm();
        const Vector out =
            (bent[corners[1]] - bent[corners[0]]).cross(bent[corners[2]] - bent[corners[0]]).normalized();
        behind_mm[moving[k].vertex] = out.dot(hits[k].position_mm - normalised.vertices_mm[moving[k].vertex]);
    }
    return find_inner_parts(normalised.vertices_mm, target.surface().triangles, normalised.landmarks, behind_mm);
}

void put(TemplatePlace& place, const geometry::SurfaceIndex& index, const geometry::SurfacePoint& hit) {
    place.corners = index.triangles()[hit.triangle];
    place.weights = hit.barycentric * (index.on_border(hit) ? faded(hit.distance_mm) : 1.0);
}

/// On which lip the vertices of somebody's mesh lie.
/// @param hits  on the template, of the vertices at `places`
std::vector<preprocessing::LipSide> own_lips_of_mesh(const TemplatePlaces& places, const PreparedTarget& target,
                                                     const geometry::SurfaceIndex& index,
                                                     std::span<const geometry::SurfacePoint> hits,
                                                     const preprocessing::FaceTemplate& face_template) {
    const auto& vertices = target.normalised(Normalisation::similarity).vertices_mm;
    const auto shares_of = preprocessing::lip_shares(face_template);
    std::vector<double> shares(vertices.size(), 0.0);
    for (std::size_t k = 0; k < hits.size(); ++k)
        for (Eigen::Index c = 0; c < 3; ++c)
            shares[places.of_vertices[k].vertex] +=
                hits[k].barycentric[c] * shares_of[index.triangles()[hits[k].triangle][static_cast<std::size_t>(c)]];
    return lip_sides_along(vertices, target.surface().triangles, shares);
}

/// The vertices that are nearest to the wrong lip go to the nearest point of their own.
void put_on_own_lips(TemplatePlaces& places, const PreparedTarget& target, const geometry::SurfaceIndex& index,
                     std::span<const preprocessing::LipSide> own, const preprocessing::FaceTemplate& face_template) {
    using preprocessing::LipSide;
    const auto& vertices = target.normalised(Normalisation::similarity).vertices_mm;
    const auto side_of = preprocessing::lip_sides(face_template);
    for (const auto lip : {LipSide::upper, LipSide::lower}) {
        std::vector<geometry::Triangle> of_lip;
        for (std::size_t t = 0; t < side_of.size(); ++t)
            if (side_of[t] == lip || side_of[t] == LipSide::neither)
                of_lip.push_back(face_template.surface.triangles[t]);
        const geometry::SurfaceIndex lip_index(index.vertices_mm(), of_lip);
        for (auto& place : places.of_vertices) {
            auto& side = places.lip_sides[place.vertex];
            if (own[place.vertex] != lip || side == lip) continue;
            put(place, lip_index, lip_index.closest(vertices[place.vertex]));
            side = lip;
        }
    }
}

/// The vertices beyond the rim move by all of the rim near them. Close to it the nearest point, which most of them were
/// put at, goes over into that.
/// @param hits  on the template, of the vertices at `places`
void put_beyond_rim(TemplatePlaces& places, std::span<const Point> vertices_mm, const geometry::SurfaceIndex& index,
                    std::span<const geometry::SurfacePoint> hits, const preprocessing::FaceTemplate& face_template) {
    constexpr double close_mm = 2.0;  // the template's own spacing
    std::vector<std::uint8_t> of_lips(index.vertices_mm().size(), 0);
    for (const auto* line : {&face_template.upper_lip_line, &face_template.lower_lip_line})
        for (const auto v : *line) of_lips[v] = 1;
    const RimMotion rim(index.vertices_mm(), index.triangles(), of_lips);
    for (std::size_t k = 0; k < hits.size(); ++k) {
        auto& place = places.of_vertices[k];
        const double distance_mm = hits[k].distance_mm;
        if (!index.on_border(hits[k]) || !(distance_mm > 0) || place.weights.isZero(0)) continue;
        bool of_rim = true;
        for (std::size_t c = 0; c < 3; ++c)
            of_rim = of_rim && (hits[k].barycentric[static_cast<Eigen::Index>(c)] == 0 ||
                                rim.on_rim(index.triangles()[hits[k].triangle][c]));
        if (!of_rim) continue;
        auto shares = rim.shares(vertices_mm[place.vertex], distance_mm);
        if (shares.empty()) continue;
        const double over = std::min(1.0, distance_mm / close_mm);
        for (auto& share : shares) share.share *= over * faded(distance_mm);
        if (over < 1)
            for (std::size_t c = 0; c < 3; ++c)
                shares.push_back({place.corners[c], (1 - over) * place.weights[static_cast<Eigen::Index>(c)]});
        places.beyond_rim.push_back({place.vertex, std::move(shares)});
        place.weights.setZero();
    }
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
        put(place, index, hits[k]);
        places.lip_sides[place.vertex] = side_of[hits[k].triangle];
    }
    const auto own = surface.grid ? evened_lip_sides(places.lip_sides, *surface.grid)
                                  : own_lips_of_mesh(places, target, index, hits, face_template);
    put_on_own_lips(places, target, index, own, face_template);
    if (!target.face()) places.inner = inner_parts_of(target, index, places.of_vertices, hits);
    put_beyond_rim(places, vertices, index, hits, face_template);
    std::erase_if(places.of_vertices, [](const TemplatePlace& place) { return place.weights.isZero(0); });
    places.bent_mm.assign(index.vertices_mm().begin(), index.vertices_mm().end());
    places.turns = modeling::skin_turns(face_template, face_template.surface.vertices_mm, places.bent_mm);
    return places;
}

/// Kept with the target, which outlives what is made of it here.
const TemplatePlaces& places_on(const PreparedTarget& target,
                                const std::shared_ptr<const KeptRegistrations>& registrations) {
    const auto kept = target.kept(registrations, [&]() -> std::shared_ptr<const void> {
        return std::make_shared<const TemplatePlaces>(locate(target, *registrations));
    });
    return *static_cast<const TemplatePlaces*>(kept.get());
}

/// How the skin of the chin moves, average frame.
Vector chin_motion(const modeling::TemplateMotion& dense) {
    constexpr double around_mm = 10.0;
    const auto& rest = dense.face_template().surface;
    const auto* chin = rest.landmarks.find("chin");
    Vector sum = Vector::Zero();
    double count = 0;
    for (std::size_t v = 0; chin && v < rest.size(); ++v)
        if ((rest.vertices_mm[v] - chin->position_mm).norm() < around_mm) {
            sum += dense.motion_mm[v];
            ++count;
        }
    return count > 0 ? Vector(sum / count) : sum;
}

/// The motion of the template's vertices on a target, average frame.
std::vector<Vector> motion_on(const TemplatePlaces& places, const modeling::TemplateMotion& dense) {
    auto motion_mm = dense.motion_mm;
    if (!dense.follows_skin) return motion_mm;
    for (std::size_t v = 0; v < motion_mm.size(); ++v) motion_mm[v] = places.turns[v] * motion_mm[v];
    return motion_mm;
}

void move_inner_parts(geometry::DisplacementField& field, const PreparedTarget& target, const InnerParts& inner,
                      const modeling::TemplateMotion& dense, const Eigen::Matrix3d& target_from_average) {
    if (inner.empty()) return;
    const auto& normalised = target.normalised(Normalisation::similarity);
    const auto turn = jaw_turn(normalised.landmarks, chin_motion(dense));
    for (std::size_t v = 0; v < inner.inside.size(); ++v) {
        if (inner.inside[v] == 0) continue;
        const Point& p = normalised.vertices_mm[v];
        const Vector on_jaw = inner.on_jaw[v] * (turn * p - p);
        field.mm[v] = (1 - inner.inside[v]) * field.mm[v] + inner.inside[v] * (target_from_average * on_jaw);
    }
}

}  // namespace

std::span<const Point> template_on(const PreparedTarget& target,
                                   const std::shared_ptr<const KeptRegistrations>& registrations) {
    return places_on(target, registrations).bent_mm;
}

std::vector<preprocessing::LipSide> lip_sides(const PreparedTarget& target, const modeling::TemplateMotion& dense) {
    return places_on(target, dense.registrations).lip_sides;
}

geometry::DisplacementField dense_field(const PreparedTarget& target, const modeling::TemplateMotion& dense) {
    const Eigen::Matrix3d target_from_average =
        target.average_from_target(Normalisation::similarity).linear().inverse();
    auto field = geometry::DisplacementField::still(target.surface().size());
    field.answered = target.surface().present;
    const auto& places = places_on(target, dense.registrations);
    const auto motion_mm = motion_on(places, dense);
    for (const auto& place : places.of_vertices) {
        Vector motion = Vector::Zero();
        for (std::size_t c = 0; c < 3; ++c)
            motion += place.weights[static_cast<Eigen::Index>(c)] * motion_mm[place.corners[c]];
        field.mm[place.vertex] = target_from_average * motion;
    }
    for (const auto& place : places.beyond_rim) {
        Vector motion = Vector::Zero();
        for (const auto& [vertex, share] : place.shares) motion += share * motion_mm[vertex];
        field.mm[place.vertex] = target_from_average * motion;
    }
    move_inner_parts(field, target, places.inner, dense, target_from_average);
    return field;
}

}  // namespace mimik::animation
