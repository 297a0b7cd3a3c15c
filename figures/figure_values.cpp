#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "figures/figure.h"

// What a figure is, apart from how it is drawn: whoever writes descriptions needs no VTK.

namespace mimik::figures {
namespace {

void check_panel(const Panel& panel, const std::string& where) {
    const auto& mesh = panel.mesh;
    const auto vertices = mesh.vertices_mm.size();
    const auto require = [&](bool good, const std::string& what) {
        if (!good) throw InputError(where + what);
    };
    for (const auto corner : mesh.faces.corners)
        require(corner < vertices, fmt::format("a face has the corner {}; there are {} vertices", corner, vertices));
    require(mesh.colours.empty() || mesh.colours.size() == vertices,
            fmt::format("{} for {} vertices", base::counted(mesh.colours.size(), "colour"), vertices));
    require(std::isfinite(panel.view.yaw_deg) && std::abs(panel.view.yaw_deg) <= 180,
            fmt::format("yaw_deg is {}; give -180 to 180", panel.view.yaw_deg));
    require(std::isfinite(panel.view.pitch_deg) && std::abs(panel.view.pitch_deg) <= 89,
            fmt::format("pitch_deg is {}; give -89 to 89", panel.view.pitch_deg));
    if (panel.texture && !panel.scalar && vertices > 0) {
        const auto& image = *panel.texture;
        require(
            image.width > 0 && image.height > 0 &&
                image.rgb.size() == 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
            fmt::format("the texture is {} x {} with {} bytes", image.width, image.height, image.rgb.size()));
        require(!mesh.texture_coordinates.empty(), "there is a texture, but the mesh has no texture coordinates");
        const auto& texture_corners = mesh.faces.texture_corners;
        require(texture_corners.empty() ? mesh.texture_coordinates.size() == vertices
                                        : texture_corners.size() == mesh.faces.corners.size(),
                "texture coordinates do not go with the vertices");
        for (const auto corner : texture_corners)
            require(corner < mesh.texture_coordinates.size(), fmt::format("texture corner {} of {} texture coordinates",
                                                                          corner, mesh.texture_coordinates.size()));
    }
    for (const auto& set : panel.markers) {
        require(set.radius_mm > 0 && set.radius_mm < 1000,
                fmt::format("markers '{}': radius_mm is {}; give more than 0", set.name, set.radius_mm));
        for (const auto& p : set.positions_mm)
            require(p.allFinite(), fmt::format("markers '{}': a position is not finite", set.name));
    }
    for (const auto& set : panel.arrows) {
        require(set.radius_mm > 0 && set.radius_mm < 1000,
                fmt::format("arrows '{}': radius_mm is {}; give more than 0", set.name, set.radius_mm));
        for (const auto& a : set.arrows)
            require(a.from_mm.allFinite() && a.to_mm.allFinite(),
                    fmt::format("arrows '{}': an end is not finite", set.name));
    }
    if (panel.scalar && panel.scalar->range)
        require(std::isfinite((*panel.scalar->range)[0]) && std::isfinite((*panel.scalar->range)[1]) &&
                    (*panel.scalar->range)[0] < (*panel.scalar->range)[1],
                fmt::format("scalar '{}': range is {} to {}; give a lower and an upper value", panel.scalar->attribute,
                            (*panel.scalar->range)[0], (*panel.scalar->range)[1]));
}

}  // namespace

std::vector<double> scalar_values(const geometry::Mesh& mesh, const std::string& attribute) {
    std::string names;
    for (const auto& candidate : mesh.attributes) {
        names += (names.empty() ? "" : ", ") + candidate.name;
        if (candidate.name != attribute) continue;
        const auto components = static_cast<std::size_t>(std::max(1, candidate.components));
        if (candidate.values.size() != components * mesh.vertices_mm.size())
            throw InputError(fmt::format("attribute '{}' has {} values, not {} for each of {} vertices", attribute,
                                         candidate.values.size(), components, mesh.vertices_mm.size()));
        if (components == 1) return candidate.values;
        std::vector<double> lengths(mesh.vertices_mm.size());
        for (std::size_t v = 0; v < lengths.size(); ++v)
            lengths[v] = Eigen::Map<const Eigen::VectorXd>(&candidate.values[v * components],
                                                           static_cast<Eigen::Index>(components))
                             .norm();
        return lengths;
    }
    throw InputError(
        fmt::format("the mesh has no attribute '{}'; it has: {}", attribute, names.empty() ? "none" : names));
}

View parse_view(const std::string& name) {
    static const std::vector<std::pair<std::string, View>> views = {
        {"front", {0, 0}},
        {"left", {90, 0}},
        {"right", {-90, 0}},
        {"three-quarter-left", {35, 0}},
        {"three-quarter-right", {-35, 0}},
    };
    const std::string wanted = name == "three-quarter" ? "three-quarter-left" : name;
    std::string names;
    for (const auto& [known, view] : views) {
        if (known == wanted) return view;
        names += (names.empty() ? "" : ", ") + known;
    }
    throw InputError(fmt::format("view {} is not known; give one of {}", base::in_quotes(name), names));
}

Framing parse_framing(const std::string& name) {
    if (name == "own") return Framing::own;
    if (name == "common") return Framing::common;
    throw InputError(fmt::format("framing {} is not known; give own or common", base::in_quotes(name)));
}

void Figure::check() const {
    if (panels.empty()) throw InputError("the figure has no panel; give at least one mesh");
    const auto within = [](const char* field, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw InputError(fmt::format("{} is {}; give {} to {}", field, value, low, high));
    };
    within("columns", columns, 0, 1000);
    within("panel_width_px", panel_width_px, 16, 8000);
    within("panel_height_px", panel_height_px, 16, 8000);
    within("font_size_px", font_size_px, 6, 200);
    within("scale_bar_mm", scale_bar_mm, 0, 1e6);
    within("supersampling", supersampling, 1, 4);
    within("dots_per_inch", dots_per_inch, 0, 10000);
    if (height_mm) within("height_mm", *height_mm, 1e-6, 1e9);
    for (std::size_t p = 0; p < panels.size(); ++p)
        check_panel(panels[p], fmt::format("panel {}{}: ", p + 1,
                                           panels[p].caption.empty() ? "" : fmt::format(" ('{}')", panels[p].caption)));
}

}  // namespace mimik::figures
