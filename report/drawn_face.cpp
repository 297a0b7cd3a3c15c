#include "report/drawn_face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "animation/face_export.h"
#include "animation/open_inside.h"
#include "animation/torn_faces.h"
#include "base/errors.h"
#include "geometry/box.h"
#include "geometry/rim_bays.h"
#include "geometry/topology.h"
#include "geometry/weld.h"
#include "io/image.h"

namespace mimik::report {

using figures::Colour;
using geometry::Mesh;
using geometry::Point;
using preprocessing::Face;

namespace {

constexpr Colour filled_colour = {236, 228, 222};  // skin's own lightness with less of its colour
constexpr Colour marked_colour = {150, 190, 120};  // as on quality sheets

geometry::BridgedVertices bridged_of(HoleDrawing holes) {
    return holes == HoleDrawing::gap ? geometry::BridgedVertices::leave_out : geometry::BridgedVertices::keep;
}

void colour_by_origin(Mesh& mesh, const geometry::QuadGrid& grid, HoleDrawing holes,
                      const std::vector<std::uint32_t>& kept) {
    mesh.colours.clear();
    mesh.colours.reserve(kept.size());
    for (const auto v : kept)
        mesh.colours.push_back(grid.measured(v)             ? figures::skin
                               : holes == HoleDrawing::mark ? marked_colour
                                                            : filled_colour);
}

/// The wider lips part, the darker it is between them: a slit of a millimetre is no open mouth.
Colour inside_colour(double longest_mm) {
    constexpr double closed_mm = 1.5, open_mm = 4;
    const double t = std::clamp((longest_mm - closed_mm) / (open_mm - closed_mm), 0.0, 1.0);
    Colour colour{};
    for (std::size_t k = 0; k < 3; ++k)
        colour[k] = static_cast<std::uint8_t>(
            std::lround(figures::skin[k] + t * (animation::inside_colour[k] - figures::skin[k])));
    return colour;
}

/// The quads that a motion tears, as a surface of its own: its vertices are not those of the skin, which is lit and
/// coloured apart. All of it is as dark as the widest tenth, so that no stripes run through the mouth.
void add_inside_of_mouth(Mesh& mesh, const animation::AnimatedFace& animated, const Face& neutral,
                         const std::vector<Point>& moved_mm) {
    const auto quads = geometry::quads(neutral.grid);
    const auto torn = animation::torn_faces(animated, animated.field.mm, quads);
    std::vector<double> longest_mm;
    for (std::size_t f = 0; f < quads.size(); ++f) {
        if (!torn[f]) continue;
        const auto corners = quads[f];
        double& longest = longest_mm.emplace_back(0);
        for (std::size_t k = 0; k < corners.size(); ++k)
            longest = std::max(longest, (moved_mm[corners[k]] - moved_mm[corners[(k + 1) % corners.size()]]).norm());
    }
    if (longest_mm.empty()) return;
    const auto widest = longest_mm.begin() + static_cast<std::ptrdiff_t>(longest_mm.size() * 9 / 10);
    std::nth_element(longest_mm.begin(), widest, longest_mm.end());
    const auto colour = inside_colour(*widest);
    std::map<std::uint32_t, std::uint32_t> place;  // in the mesh, by vertex of the grid
    for (std::size_t f = 0; f < quads.size(); ++f) {
        if (!torn[f]) continue;
        std::vector<std::uint32_t> own;
        for (const auto v : quads[f]) {
            const auto [found, is_new] = place.emplace(v, static_cast<std::uint32_t>(mesh.vertices_mm.size()));
            own.push_back(found->second);
            if (!is_new) continue;
            mesh.vertices_mm.push_back(moved_mm[v]);
            mesh.colours.push_back(colour);
            if (!mesh.texture_coordinates.empty())
                mesh.texture_coordinates.push_back(neutral.grid.texture_coordinates[v]);
            for (auto& attribute : mesh.attributes)
                attribute.values.insert(attribute.values.end(), static_cast<std::size_t>(attribute.components),
                                        std::numeric_limits<double>::quiet_NaN());
        }
        mesh.faces.add(own);
    }
}

}  // namespace

Mesh drawn_surface(const geometry::QuadGrid& grid, HoleDrawing holes, const geometry::Transform& drawn_from_grid,
                   std::vector<std::uint32_t>* kept) {
    std::vector<std::uint32_t> own;
    auto mesh = geometry::to_mesh(geometry::without_rim_bays(grid), bridged_of(holes), &own);
    for (auto& p : mesh.vertices_mm) p = drawn_from_grid * p;
    colour_by_origin(mesh, grid, holes, own);
    if (kept) *kept = std::move(own);
    return mesh;
}

Mesh largest_part(const Mesh& mesh) {
    const auto part = geometry::connected_parts(mesh.vertices_mm, geometry::triangulate(mesh.faces));
    std::map<std::uint32_t, std::size_t> sizes;
    for (const auto p : part)
        if (p != geometry::not_welded) ++sizes[p];
    if (sizes.empty()) return mesh;
    const auto largest = std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) {
                             return a.second < b.second;
                         })->first;
    Mesh result;
    for (const auto& attribute : mesh.attributes)
        result.attributes.push_back({attribute.name, attribute.components, {}});
    std::vector<std::uint32_t> place(mesh.vertices_mm.size(), 0);
    for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
        if (part[v] != largest) continue;
        place[v] = static_cast<std::uint32_t>(result.vertices_mm.size());
        result.vertices_mm.push_back(mesh.vertices_mm[v]);
        if (!mesh.colours.empty()) result.colours.push_back(mesh.colours[v]);
        if (!mesh.texture_coordinates.empty()) result.texture_coordinates.push_back(mesh.texture_coordinates[v]);
        for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
            const auto first =
                mesh.attributes[a].values.begin() + static_cast<std::ptrdiff_t>(v) * mesh.attributes[a].components;
            auto& values = result.attributes[a].values;
            values.insert(values.end(), first, first + mesh.attributes[a].components);
        }
    }
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (part[mesh.faces[f].front()] != largest) continue;
        corners.clear();
        for (const auto v : mesh.faces[f]) corners.push_back(place[v]);
        result.faces.add(corners);
    }
    return result;
}

Mesh drawn_animation(const animation::AnimatedFace& animated, const Face& neutral, HoleDrawing holes,
                     std::vector<std::uint32_t>* kept) {
    std::vector<std::uint32_t> own;
    auto shown = neutral;
    shown.grid = geometry::without_rim_bays(std::move(shown.grid));
    auto mesh = animation::to_mesh(animated, shown, {.bridged = bridged_of(holes)}, &own);
    colour_by_origin(mesh, shown.grid, holes, own);
    const bool may_tear = !animated.lip_sides.empty() || !animated.lid_sheets.empty();
    if (may_tear && holes != HoleDrawing::gap)
        add_inside_of_mouth(mesh, animated, shown, moved_vertices(neutral.grid, animated));
    if (kept) *kept = std::move(own);
    return mesh;
}

Point middle_of(const Face& neutral) {
    return geometry::box_of(geometry::to_mesh(neutral.grid, geometry::BridgedVertices::keep).vertices_mm).center();
}

figures::Figure page_of(int columns, const std::string& title) {
    figures::Figure page;
    page.title = title;
    page.columns = columns;
    page.dots_per_inch = 300;
    constexpr int page_px = 1760;  // 15 cm, the width of a page's text
    page.panel_width_px = std::min(620, page_px / std::max(1, columns));
    page.panel_height_px = page.panel_width_px * 6 / 5;
    page.font_size_px = columns <= 3 ? 30 : columns <= 4 ? 26 : 22;
    page.scale_bar_mm = 50;
    page.legend = true;
    return page;
}

void letter_panels(figures::Figure& page) {
    char letter = 'a';
    for (auto& panel : page.panels) {
        if (panel.mesh.vertices_mm.empty() && panel.caption.empty()) continue;
        panel.caption = fmt::format("({}) {}", letter, panel.caption);
        if (letter < 'z') ++letter;
    }
}

figures::Panel face_panel(Mesh mesh, const Point& centre_mm, std::string caption) {
    figures::Panel panel;
    panel.lit_as_skin = true;
    panel.mesh = std::move(mesh);
    panel.centre_mm = centre_mm;
    panel.caption = std::move(caption);
    return panel;
}

figures::Panel neutral_panel(const ShownPerson& person, HoleDrawing holes, std::string caption) {
    return face_panel(drawn_surface(person.neutral.grid, holes), middle_of(person.neutral), std::move(caption));
}

figures::Panel animated_panel(const ShownPerson& person, HoleDrawing holes, std::string caption) {
    return face_panel(drawn_animation(person.animated, person.neutral, holes), middle_of(person.neutral),
                      std::move(caption));
}

figures::Panel real_panel(const ShownPerson& person, HoleDrawing holes, std::string caption) {
    figures::Panel panel;
    if (!person.real) {
        panel.caption = person.neutral.id.subject + " was not scanned with it";
        return panel;
    }
    return face_panel(drawn_surface(person.real->grid, holes, person.real->neutral_from_scan),
                      middle_of(person.neutral), std::move(caption));
}

std::string add_photograph(figures::Panel& panel, const Face& face) {
    if (face.texture_file.empty() || face.grid.texture_coordinates.empty())
        return face.id.name() + " has no photograph: it is shown plain";
    try {
        panel.texture = io::read_image(face.texture_file);
    } catch (const InputError& e) {
        return fmt::format("{} is shown plain: {}", face.id.name(), e.what());
    }
    return {};
}

void darken_open_mouth(io::Image& photograph, const Face& face) {
    constexpr std::size_t least_vertices = 20;  // fewer, of about 2 square millimetres each, are holes in closed lips
    const auto& grid = face.grid;
    const auto* right = face.landmarks.find("mouth_corner_right");
    const auto* left = face.landmarks.find("mouth_corner_left");
    const auto* upper = face.landmarks.find("upper_lip_outer");
    const auto* lower = face.landmarks.find("lower_lip_outer");
    if (!right || !left || !upper || !lower || grid.texture_coordinates.empty()) return;
    const auto in_mouth = [&](std::uint32_t v) {
        const Point& p = grid.vertices_mm[v];
        return grid.inside(v) && !grid.measured(v) && p.x() > right->position_mm.x() && p.x() < left->position_mm.x() &&
               p.y() > lower->position_mm.y() && p.y() < upper->position_mm.y();
    };
    std::size_t hole = 0;
    for (std::uint32_t v = 0; v < grid.size(); ++v) hole += in_mouth(v) ? 1 : 0;
    if (hole < least_vertices) return;
    const auto pixel = [&](std::uint32_t v) {
        const auto& at = grid.texture_coordinates[v];
        return geometry::TextureCoordinate(at.x() * photograph.width, (1 - at.y()) * photograph.height);
    };
    const auto all = geometry::quads(grid);
    for (std::size_t f = 0; f < all.size(); ++f) {
        const auto corners = all[f];
        if (std::none_of(corners.begin(), corners.end(), in_mouth)) continue;
        geometry::TextureCoordinate first_px = pixel(corners[0]), last_px = first_px;
        for (const auto v : corners) {
            first_px = first_px.cwiseMin(pixel(v));
            last_px = last_px.cwiseMax(pixel(v));
        }
        if ((last_px - first_px).maxCoeff() > 0.1 * photograph.width) continue;  // over a seam of the picture
        const auto clamped = [](double at, int size) {
            return std::clamp(static_cast<int>(std::floor(at)), 0, size - 1);
        };
        for (int y = clamped(first_px.y(), photograph.height); y <= clamped(last_px.y(), photograph.height); ++y)
            for (int x = clamped(first_px.x(), photograph.width); x <= clamped(last_px.x(), photograph.width); ++x)
                std::copy(animation::inside_colour.begin(), animation::inside_colour.end(),
                          photograph.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * photograph.width + x));
    }
}

figures::MarkerSet landmark_markers(const geometry::Landmarks& landmarks) {
    figures::MarkerSet set{.name = "landmarks"};
    for (const auto& mark : landmarks.all()) set.positions_mm.push_back(mark.position_mm);
    return set;
}

std::vector<figures::MarkerSet> control_markers(const std::vector<ShownControl>& controls) {
    figures::MarkerSet muscles{.name = "muscle control points", .colour = figures::muscle_colour};
    figures::MarkerSet wrinkles{.name = "wrinkle control points", .colour = figures::wrinkle_colour};
    for (const auto& control : controls) {
        if (control.kind == facs::ControlKind::muscle) muscles.positions_mm.push_back(control.position_mm);
        if (control.kind == facs::ControlKind::wrinkle) wrinkles.positions_mm.push_back(control.position_mm);
    }
    std::vector<figures::MarkerSet> sets;
    for (auto* set : {&muscles, &wrinkles})
        if (!set->positions_mm.empty()) sets.push_back(std::move(*set));
    return sets;
}

}  // namespace mimik::report
