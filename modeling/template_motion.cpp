#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"
#include "io/json_values.h"
#include "modeling/skin_turn.h"
#include "modeling/template_motion_json.h"
#include "preprocessing/kept_registrations.h"

namespace mimik::modeling {

using geometry::Triangle;
using geometry::Vector;
using nlohmann::json;
using preprocessing::BoundLandmark;
using preprocessing::FaceTemplate;

namespace {

constexpr std::size_t most_vertices = 200'000;  // a template has some thousands
constexpr std::size_t most_corners = 64;        // of triangles at one vertex: what is solved grows with their square

json to_json(const std::vector<Vector>& vectors) {
    auto list = json::array();
    for (const auto& vector : vectors) list.push_back(io::to_json(vector));
    return list;
}

std::vector<Vector> vectors_from_json(const json& document, const char* key) {
    std::vector<Vector> vectors;
    io::read_list(document, key, [&](const json& value) {
        if (vectors.size() == most_vertices)
            throw InputError(fmt::format("more than the {} vertices that are read", most_vertices));
        vectors.push_back(io::vector_from_json(value));
        if (!vectors.back().allFinite()) throw InputError("it is not finite");
    });
    return vectors;
}

Triangle triangle_from_json(const json& value, std::size_t vertices) {
    if (!value.is_array() || value.size() != 3) throw InputError(io::shown(value) + " is no list of three vertices");
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k)
        triangle[k] = static_cast<std::uint32_t>(io::whole_number_below(vertices, value[k], "a corner"));
    return triangle;
}

std::vector<std::uint32_t> line_from_json(const json& document, const char* key, std::size_t vertices) {
    std::vector<std::uint32_t> line;
    io::read_list(document, key, [&](const json& value) {
        line.push_back(static_cast<std::uint32_t>(io::whole_number_below(vertices, value, "a vertex")));
    });
    return line;
}

/// @throws InputError if a vertex is the corner of more triangles than a surface needs.
void check_triangles(const FaceTemplate& made) {
    if (made.surface.triangles.empty()) throw InputError("there is no triangle in it");
    std::vector<std::size_t> corners(made.size(), 0);
    for (const auto& triangle : made.surface.triangles)
        for (const auto v : triangle)
            if (++corners[v] > most_corners)
                throw InputError(fmt::format("more than {} triangles meet in vertex {}", most_corners, v));
}

/// @throws InputError if the two sides of the cut do not belong together.
void check_cut(const FaceTemplate& made) {
    if (made.upper_lip_line.size() != made.lower_lip_line.size())
        throw InputError(fmt::format("upper_lip_line has {} vertices, lower_lip_line {}", made.upper_lip_line.size(),
                                     made.lower_lip_line.size()));
}

BoundLandmark bound_landmark_from_json(const json& value, std::size_t vertices) {
    BoundLandmark mark{
        io::read_field<std::string>(value, "name"),
        io::read_field(value, "corners", [&](const json& corners) { return triangle_from_json(corners, vertices); }),
        io::read_field(value, "weights", io::vector_from_json)};
    constexpr double rounding = 1e-6;
    if (!(std::abs(mark.weights.sum() - 1.0) < rounding && mark.weights.minCoeff() >= -rounding))
        throw InputError(fmt::format("weights of landmark '{}' are no shares of 1", mark.name));
    return mark;
}

FaceTemplate template_from_json(const json& document) {
    FaceTemplate made;
    auto& surface = made.surface;
    surface.vertices_mm = vectors_from_json(document, "vertices_mm");
    const auto size = surface.size();
    io::read_list(document, "triangles",
                  [&](const json& value) { surface.triangles.push_back(triangle_from_json(value, size)); });
    check_triangles(made);
    surface.present.assign(size, 1);
    surface.measured.assign(size, 1);
    surface.landmarks = io::landmarks_from_json(document, "landmarks");
    made.mirror = line_from_json(document, "mirror", size);
    if (made.mirror.size() != size)
        throw InputError(fmt::format("mirror has {} vertices, the template {}", made.mirror.size(), size));
    made.upper_lip_line = line_from_json(document, "upper_lip_line", size);
    made.lower_lip_line = line_from_json(document, "lower_lip_line", size);
    check_cut(made);
    io::read_list(document, "bound_landmarks",
                  [&](const json& value) { made.landmarks.push_back(bound_landmark_from_json(value, size)); });
    return made;
}

}  // namespace

const FaceTemplate& TemplateMotion::face_template() const { return registrations->face_template(); }

TemplateMotion motion_on_template(const std::shared_ptr<const preprocessing::KeptRegistrations>& registrations,
                                  const preprocessing::Face& neutral, const preprocessing::Face& expressive) {
    TemplateMotion dense{registrations, registrations->motion(neutral, expressive).motion_mm, true};
    const auto turns = skin_turns(dense.face_template(), registrations->neutral(neutral).vertices_mm,
                                  dense.face_template().surface.vertices_mm);
    for (std::size_t v = 0; v < turns.size(); ++v) dense.motion_mm[v] = turns[v] * dense.motion_mm[v];
    return dense;
}

void keep_side(TemplateMotion& dense, const facs::Expression& expression) {
    constexpr double blend_mm = 20.0;
    const auto units = expression.units();
    if (units.empty()) return;
    const auto side = units.front().side;
    for (const auto& unit : units)
        if (unit.side != side) return;
    if (side == facs::Side::both) return;
    const double sign = side == facs::Side::left ? 1.0 : -1.0;
    const auto& rest_mm = dense.face_template().surface.vertices_mm;
    for (std::size_t v = 0; v < rest_mm.size(); ++v) {
        const double t = std::clamp(0.5 + sign * rest_mm[v].x() / blend_mm, 0.0, 1.0);
        dense.motion_mm[v] *= t * t * (3.0 - 2.0 * t);
    }
}

void share_registrations(TemplateMotion& dense, const std::shared_ptr<const preprocessing::KeptRegistrations>& known) {
    if (preprocessing::template_fingerprint(dense.face_template()) ==
        preprocessing::template_fingerprint(known->face_template()))
        dense.registrations = known;
}

json template_motion_to_json(const TemplateMotion& dense) {
    const auto& made = dense.face_template();
    auto triangles = json::array(), bound = json::array();
    for (const auto& triangle : made.surface.triangles) triangles.push_back(triangle);
    for (const auto& mark : made.landmarks)
        bound.push_back(
            {{"name", mark.name}, {"corners", mark.corners}, {"weights", io::to_json(Vector(mark.weights))}});
    return {{"template",
             {{"vertices_mm", to_json(made.surface.vertices_mm)},
              {"triangles", triangles},
              {"landmarks", io::to_json(made.surface.landmarks)},
              {"mirror", made.mirror},
              {"upper_lip_line", made.upper_lip_line},
              {"lower_lip_line", made.lower_lip_line},
              {"bound_landmarks", bound}}},
            {"motion_mm", to_json(dense.motion_mm)},
            {"follows_skin", dense.follows_skin}};
}

TemplateMotion template_motion_from_json(const json& document) {
    TemplateMotion dense;
    auto made = io::read_field(document, "template", template_from_json);
    dense.motion_mm = vectors_from_json(document, "motion_mm");
    dense.follows_skin = document.value("follows_skin", false);  // models of before do not say it
    if (dense.motion_mm.size() != made.size())
        throw InputError(
            fmt::format("motion_mm has {} vectors, the template {} vertices", dense.motion_mm.size(), made.size()));
    dense.registrations = std::make_shared<const preprocessing::KeptRegistrations>(std::move(made));
    return dense;
}

}  // namespace mimik::modeling
