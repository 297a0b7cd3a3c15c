#include "builtin/template_on_mesh.h"

#include <cstdint>
#include <vector>

#include "animation/mesh_lips.h"
#include "geometry/surface_index.h"

namespace mimik::builtin {

using geometry::SurfaceIndex;
using geometry::Triangle;
using preprocessing::LipSide;

namespace {

/// On which lip the vertices of the mesh lie, by the template that was bent on to it.
std::vector<LipSide> lip_sides_of(const geometry::FaceSurface& mesh, const preprocessing::FaceTemplate& face_template,
                                  const std::vector<geometry::Point>& bent_mm, const std::vector<double>& shares) {
    constexpr double near_mm = 12.0;  // beyond the rim of the template nothing is a lip
    const auto hits = SurfaceIndex(bent_mm, face_template.surface.triangles).closest(mesh.vertices_mm);
    std::vector<double> of_mesh(mesh.size(), 0.0);
    for (std::size_t v = 0; v < mesh.size(); ++v) {
        if (hits[v].distance_mm > near_mm) continue;
        const auto& corners = face_template.surface.triangles[hits[v].triangle];
        for (std::size_t c = 0; c < 3; ++c)
            of_mesh[v] += hits[v].barycentric[static_cast<Eigen::Index>(c)] * shares[corners[c]];
    }
    return animation::lip_sides_along(mesh.vertices_mm, mesh.triangles, of_mesh);
}

/// What of the mesh is not the other lip.
std::vector<Triangle> triangles_for(LipSide lip, const geometry::FaceSurface& mesh, const std::vector<LipSide>& sides) {
    std::vector<Triangle> of_lip;
    for (const auto& t : mesh.triangles) {
        bool other = false;
        for (const auto v : t) other = other || (sides[v] != lip && sides[v] != LipSide::neither);
        if (!other) of_lip.push_back(t);
    }
    return of_lip;
}

}  // namespace

database::MaterialPoints template_on_mesh(const preprocessing::TemplateRegistration& registration,
                                          const geometry::FaceSurface& mesh) {
    const auto& face_template = registration.face_template();
    const auto bent_mm =
        registration.neutral(preprocessing::FitTarget(mesh.vertices_mm, mesh.triangles), mesh.landmarks).vertices_mm;
    const auto shares = preprocessing::lip_shares(face_template);
    const auto sides = lip_sides_of(mesh, face_template, bent_mm, shares);

    database::MaterialPoints places;
    places.triangles.resize(bent_mm.size());
    places.barycentric.resize(bent_mm.size());
    const auto place = [&](const std::vector<Triangle>& triangles, const auto& takes) {
        const SurfaceIndex index(mesh.vertices_mm, triangles);
        for (std::size_t v = 0; v < bent_mm.size(); ++v) {
            if (!takes(shares[v])) continue;
            const auto hit = index.closest(bent_mm[v]);
            places.triangles[v] = triangles[hit.triangle];
            places.barycentric[v] = hit.barycentric;
        }
    };
    place(mesh.triangles, [](double share) { return share == 0; });
    place(triangles_for(LipSide::upper, mesh, sides), [](double share) { return share > 0; });
    place(triangles_for(LipSide::lower, mesh, sides), [](double share) { return share < 0; });
    return places;
}

}  // namespace mimik::builtin
