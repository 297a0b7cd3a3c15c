#include "animation/open_inside.h"

#include <map>
#include <utility>

#include "base/errors.h"

namespace mimik::animation {

using geometry::Mesh;
using geometry::Point;

namespace {

constexpr double behind_mm = 1;
constexpr const char* one_coordinate = "a surface that opens needs texture coordinates one per vertex";

/// A cut through an edge of the mesh, as seen from the end it moves with: that end, the other one.
using HalfEdge = std::pair<std::uint32_t, std::uint32_t>;

class Opener {
public:
    Opener(const Mesh& mesh, std::span<const std::uint32_t> sheet) : mesh_(mesh), sheet_(sheet) {
        surface_.mesh = mesh;
        surface_.mesh.faces = {};
        for (std::uint32_t v = 0; v < mesh.vertices_mm.size(); ++v) surface_.moves_with.push_back(v);
    }

    void keep(std::span<const std::uint32_t> corners) { surface_.mesh.faces.add(corners); }

    void cut(std::span<const std::uint32_t> corners) {
        const auto next = [&](std::size_t k) { return (k + 1) % corners.size(); };
        std::vector<std::size_t> cuts;  // edges k to k + 1
        for (std::size_t k = 0; k < corners.size(); ++k)
            if (sheet_[corners[k]] != sheet_[corners[next(k)]]) cuts.push_back(k);
        if (cuts.empty()) return keep(corners);
        std::vector<HalfEdge> between;
        for (std::size_t c = 0; c < cuts.size(); ++c) {
            const auto before = corners[cuts[c]], after = corners[next(cuts[c])];
            between.emplace_back(before, after);
            between.emplace_back(after, before);
            // The corners of one sheet from this cut to the next one.
            const auto end = cuts[(c + 1) % cuts.size()];
            std::vector<std::uint32_t> half = {skin_vertex({after, before})};
            std::size_t k = next(cuts[c]);
            for (; k != end; k = next(k)) half.push_back(corners[k]);
            half.push_back(corners[end]);
            half.push_back(skin_vertex({corners[end], corners[next(end)]}));
            surface_.mesh.faces.add(half);
        }
        dark_.push_back(std::move(between));
    }

    /// A dark face between vertices that there are.
    void between(std::initializer_list<std::uint32_t> corners) {
        auto& face = dark_.emplace_back();
        for (const auto v : corners)
            if (face.empty() || (face.back().first != v && face.front().first != v)) face.emplace_back(v, v);
    }

    /// The dark faces come last, and so do their vertices.
    OpenableSurface finished() {
        surface_.skin_vertices = surface_.mesh.vertices_mm.size();
        std::map<HalfEdge, std::uint32_t> made;
        for (const auto& face : dark_) {
            std::vector<std::uint32_t> corners;
            corners.reserve(face.size());
            for (const auto& edge : face) corners.push_back(vertex(made, edge, behind_mm));
            surface_.mesh.faces.add(corners);
        }
        return std::move(surface_);
    }

private:
    std::uint32_t skin_vertex(const HalfEdge& edge) { return vertex(skin_, edge, 0); }

    std::uint32_t vertex(std::map<HalfEdge, std::uint32_t>& made, const HalfEdge& edge, double depth_mm) {
        auto& all = surface_.mesh;
        const auto [place, is_new] = made.emplace(edge, static_cast<std::uint32_t>(all.vertices_mm.size()));
        if (!is_new) return place->second;
        const auto [own, other] = edge;
        // Both ends of the sum in one order: the halves meet to the last bit.
        const auto [first, second] = std::minmax(own, other);
        const Point middle = 0.5 * (mesh_.vertices_mm[first] + mesh_.vertices_mm[second]);
        all.vertices_mm.emplace_back(middle - depth_mm * geometry::Vector::UnitZ());
        surface_.moves_with.push_back(own);
        if (!mesh_.texture_coordinates.empty())
            all.texture_coordinates.emplace_back(
                0.5 * (mesh_.texture_coordinates[first] + mesh_.texture_coordinates[second]));
        if (!mesh_.colours.empty()) all.colours.push_back(mesh_.colours[own]);
        for (std::size_t a = 0; a < all.attributes.size(); ++a)
            for (int c = 0; c < all.attributes[a].components; ++c)
                all.attributes[a].values.push_back(
                    mesh_.attributes[a]
                        .values[static_cast<std::size_t>(own) * static_cast<std::size_t>(all.attributes[a].components) +
                                static_cast<std::size_t>(c)]);
        return place->second;
    }

    const Mesh& mesh_;
    std::span<const std::uint32_t> sheet_;
    OpenableSurface surface_;
    std::map<HalfEdge, std::uint32_t> skin_;
    std::vector<std::vector<HalfEdge>> dark_;
};

}  // namespace

OpenableSurface open_between_sheets(const Mesh& mesh, std::span<const std::uint8_t> is_torn,
                                    std::span<const std::uint32_t> sheet) {
    if (is_torn.size() != mesh.faces.size() || sheet.size() != mesh.vertices_mm.size())
        throw InputError("open_between_sheets: one mark a face and one sheet a vertex are needed");
    if (!mesh.faces.texture_corners.empty()) throw InputError(one_coordinate);
    Opener opener(mesh, sheet);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        is_torn[f] ? opener.cut(mesh.faces[f]) : opener.keep(mesh.faces[f]);
    return opener.finished();
}

OpenableSurface open_between_lines(const Mesh& mesh, std::span<const std::uint32_t> upper,
                                   std::span<const std::uint32_t> lower) {
    if (upper.size() != lower.size())
        throw InputError("open_between_lines: both lines need as many vertices as the other");
    if (!mesh.faces.texture_corners.empty()) throw InputError(one_coordinate);
    Opener opener(mesh, {});
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) opener.keep(mesh.faces[f]);
    for (std::size_t k = 0; k + 1 < upper.size(); ++k) opener.between({upper[k], lower[k], lower[k + 1], upper[k + 1]});
    return opener.finished();
}

void colour_inside(OpenableSurface& surface, const std::array<std::uint8_t, 3>& skin) {
    surface.mesh.colours.assign(surface.skin_vertices, skin);
    surface.mesh.colours.resize(surface.mesh.vertices_mm.size(), inside_colour);
}

}  // namespace mimik::animation
