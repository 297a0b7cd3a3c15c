#include "evaluation/per_vertex.h"

#include <cctype>
#include <limits>

#include <fmt/format.h>

#include "base/content_hash.h"
#include "base/errors.h"
#include "base/text.h"

namespace mimik::evaluation {

using geometry::Point;

bool CaseChoice::fits(const CaseKey& key) const {
    return key.target == target && key.expression == expression && variant_of(key) == method &&
           (source.empty() || source == key.source);
}

std::string CaseChoice::text() const {
    return fmt::format("{}:{}:{}{}", target, expression, method, source.empty() ? "" : ":" + source);
}

CaseChoice parse_case_choice(std::string_view text) {
    std::vector<std::string> words(1);
    for (const char c : text)
        if (c == ':')
            words.emplace_back();
        else
            words.back() += c;
    bool whole = words.size() == 3 || words.size() == 4;
    for (const auto& word : words) whole = whole && !word.empty();
    if (!whole)
        throw InputError(
            fmt::format("case {} is none; give TARGET:EXPRESSION:METHOD, such as \"bs000:12:default\", or "
                        "TARGET:EXPRESSION:METHOD:SOURCE",
                        base::in_quotes(std::string(text))));
    return {words[0], words[1], words[2], words.size() == 4 ? words[3] : ""};
}

std::vector<double> vertex_errors_mm(const JudgedFace& face) {
    const auto& target = face.target;
    std::vector<double> error_mm(face.neutral.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<Point> queries;
    std::vector<std::uint32_t> moved;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
        if (!target.whole_face && !target.in_zone[k]) continue;
        const std::uint32_t v = target.vertices[k];
        error_mm[v] = target.nothing_mm[k];
        const Point moved_mm = face.neutral.vertices_mm[v] + face.way_mm(v);
        if (!moved_mm.allFinite() || moved_mm == face.neutral.vertices_mm[v]) continue;
        moved.push_back(v);
        queries.push_back(moved_mm);
    }
    const auto hits = target.expressive->closest(queries);
    for (std::size_t i = 0; i < moved.size(); ++i) error_mm[moved[i]] = hits[i].distance_mm;
    return error_mm;
}

geometry::Mesh judged_mesh(const JudgedFace& face, const std::vector<double>& error_mm) {
    const auto& neutral = face.neutral;
    std::vector<double> in_zone(neutral.size(), 0);
    for (std::size_t k = 0; k < face.target.vertices.size(); ++k)
        in_zone[face.target.vertices[k]] = face.target.in_zone[k] ? 1 : 0;
    geometry::Mesh mesh;
    geometry::VertexAttribute error{"error_mm", 1, {}}, zone{"in_zone", 1, {}}, way{"displacement_mm", 3, {}},
        place{"grid_vertex", 1, {}};
    std::vector<std::uint32_t> number(neutral.size(), 0);
    for (std::uint32_t v = 0; v < neutral.size(); ++v) {
        if (!neutral.present[v]) continue;
        number[v] = static_cast<std::uint32_t>(mesh.vertices_mm.size());
        const auto way_mm = face.way_mm(v);
        mesh.vertices_mm.emplace_back(neutral.vertices_mm[v] + way_mm);
        error.values.push_back(error_mm[v]);
        zone.values.push_back(in_zone[v]);
        way.values.insert(way.values.end(), way_mm.begin(), way_mm.end());
        place.values.push_back(static_cast<double>(v));
    }
    for (const auto& triangle : neutral.triangles)
        mesh.faces.add(geometry::Triangle{number[triangle[0]], number[triangle[1]], number[triangle[2]]});
    for (auto* attribute : {&error, &zone, &way, &place}) mesh.attributes.push_back(std::move(*attribute));
    return mesh;
}

std::string file_stem(const CaseKey& key) {
    auto stem = fmt::format("{}_{}_{}", key.target, key.expression, variant_of(key));
    if (!key.source.empty()) stem += "_" + key.source;
    const auto as_named = stem;
    for (char& c : stem)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 &&
            std::string_view("_-.@").find(c) == std::string_view::npos)
            c = '-';
    if (stem == as_named) return stem;
    base::ContentHash hash;  // "s 1" and "s-1" are two subjects
    hash.add(as_named);
    return stem + "-" + hash.text().substr(0, 8);
}

}  // namespace mimik::evaluation
