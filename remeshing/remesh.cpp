#include "remeshing/remesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <fmt/format.h>

#include "adapters/cgal.h"
#include "base/errors.h"
#include "remeshing/surface.h"

namespace mimik::remeshing {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Edges = Surface::Property_map<Surface::Edge_index, bool>;
using Vertices = Surface::Property_map<Surface::Vertex_index, bool>;

/// The surface with the lines on it that are kept.
struct Lined {
    Surface surface;
    std::size_t edges = 0;
};

constexpr const char *kept_edges = "e:kept", *kept_vertices = "v:kept";

Edges edges_of(Surface& surface) { return surface.add_property_map<Surface::Edge_index, bool>(kept_edges).first; }
Vertices vertices_of(Surface& surface) {
    return surface.add_property_map<Surface::Vertex_index, bool>(kept_vertices).first;
}

/// Where a line ends, branches or turns by more than 45 degrees: what resampling must not cut off.
void keep_corners(Surface& surface, const Edges& kept) {
    auto corners = vertices_of(surface);
    for (const auto v : surface.vertices()) {
        std::vector<Kernel::Vector_3> along;
        for (const auto h : surface.halfedges_around_target(surface.halfedge(v)))
            if (kept[surface.edge(h)]) along.push_back(surface.point(surface.source(h)) - surface.point(v));
        if (along.empty()) continue;
        const auto bends = [&] {
            const double lengths = std::sqrt(along[0].squared_length() * along[1].squared_length());
            return along[0] * along[1] > -std::numbers::sqrt2 / 2 * lengths;
        };
        corners[v] = along.size() != 2 || bends();
    }
}

Lined lined(const geometry::Mesh& mesh, const RemeshOptions& options, std::span<const geometry::Edge> protected_edges,
            std::vector<std::string>& remarks) {
    const auto bare = bare_surface(mesh, remarks);
    adapters::Remarks none;  // nothing but the surface is handed over
    Lined result{adapters::to_cgal<Kernel::Point_3>(bare.mesh, none), 0};
    auto kept = edges_of(result.surface);
    if (options.crease_deg > 0) PMP::detect_sharp_edges(result.surface, options.crease_deg, kept);
    for (const auto e : result.surface.edges())
        if (result.surface.is_border(e)) kept[e] = true;
    for (const auto& edge : protected_edges) {
        const auto place = [&](std::uint32_t v) { return v < bare.vertex_of.size() ? bare.vertex_of[v] : no_vertex; };
        const auto from = place(edge[0]), to = place(edge[1]);
        auto found = Surface::null_halfedge();
        if (from != no_vertex && to != no_vertex)
            found = result.surface.halfedge(Surface::Vertex_index(from), Surface::Vertex_index(to));
        if (found == Surface::null_halfedge())
            throw InputError(
                fmt::format("protected edge {}-{}: the mesh has no such edge; give two ends of one", edge[0], edge[1]));
        kept[result.surface.edge(found)] = true;
    }
    for (const auto e : result.surface.edges()) result.edges += kept[e] ? 1 : 0;
    keep_corners(result.surface, kept);
    return result;
}

/// Kept edges that are too long make the remeshing around them go on for ever.
void divide_lines(Surface& surface, Edges& kept, double edge_mm) {
    std::vector<Surface::Edge_index> lines;
    for (const auto e : surface.edges())
        if (kept[e]) lines.push_back(e);
    PMP::split_long_edges(lines, 4.0 / 3 * edge_mm, surface, CGAL::parameters::edge_is_constrained_map(kept));
}

Surface remeshed(Surface surface, const RemeshOptions& options, double edge_mm) {
    auto kept = edges_of(surface);
    auto corners = vertices_of(surface);
    if (options.keep_lines) divide_lines(surface, kept, edge_mm);
    PMP::isotropic_remeshing(surface.faces(), edge_mm, surface,
                             CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
                                 .edge_is_constrained_map(kept)
                                 .vertex_is_constrained_map(corners)
                                 .protect_constraints(options.keep_lines));
    surface.collect_garbage();
    return surface;
}

/// The edge length of equilateral triangles of which a vertex has two.
double edge_for(double area_mm2, std::size_t vertices) {
    return std::sqrt(2 / std::numbers::sqrt3 * area_mm2 / static_cast<double>(vertices));
}

/// Tries lengths until one gives the number of vertices; a border and bends make the first guess a few percent wrong.
Surface with_vertices(const Surface& lines, const RemeshOptions& options, double& edge_mm) {
    constexpr int tries = 8;
    constexpr double close_enough = 0.005;
    const auto wanted = static_cast<double>(options.vertices);
    Surface best;
    double best_ratio = 0, length_mm = edge_for(PMP::area(lines), options.vertices);
    for (int k = 0; k < tries && std::abs(best_ratio - 1) > close_enough; ++k) {
        auto surface = remeshed(lines, options, length_mm);
        const double ratio = static_cast<double>(surface.number_of_vertices()) / wanted;
        if (k == 0 || std::abs(ratio - 1) < std::abs(best_ratio - 1)) {
            best = std::move(surface);
            best_ratio = ratio;
            edge_mm = length_mm;
        }
        length_mm *= std::sqrt(ratio);
    }
    if (std::abs(best_ratio - 1) > 0.1)
        throw InputError(
            fmt::format("vertices is {}, but no edge length comes nearer than {}: borders and protected edges keep "
                        "theirs; ask for another number, or have them resampled",
                        options.vertices, best.number_of_vertices()));
    return best;
}

void remark_losses(const geometry::Mesh& mesh, std::vector<std::string>& remarks) {
    const auto left_out = [&](bool any, const std::string& what) {
        if (any) remarks.push_back(what + " left out: the vertices are new");
    };
    left_out(!mesh.texture_coordinates.empty(), "texture coordinates are");
    left_out(!mesh.colours.empty(), "colours are");
    for (const auto& attribute : mesh.attributes) left_out(true, fmt::format("attribute \"{}\" is", attribute.name));
}

}  // namespace

void RemeshOptions::check() const {
    constexpr int most_iterations = 100;
    if (vertices == 0 && !(edge_mm > 0 && std::isfinite(edge_mm)))
        throw InputError(fmt::format("edge_mm is {}; give more than 0", edge_mm));
    if (vertices > 0 && vertices < 4) throw InputError(fmt::format("vertices is {}; give 4 or more", vertices));
    if (!(crease_deg >= 0 && crease_deg <= 180))
        throw InputError(fmt::format("crease_deg is {}; give an angle between 0 and 180", crease_deg));
    if (iterations < 1 || iterations > most_iterations)
        throw InputError(fmt::format("iterations is {}; give 1 to {}", iterations, most_iterations));
}

geometry::Mesh remesh(const geometry::Mesh& mesh, const RemeshOptions& options,
                      std::span<const geometry::Edge> protected_edges, RemeshReport* report) {
    constexpr double most_vertices = 20e6;
    options.check();
    RemeshReport told;
    remark_losses(mesh, told.remarks);
    auto [lines, edges] = lined(mesh, options, protected_edges, told.remarks);
    told.protected_edges = edges;
    const double area_mm2 = PMP::area(lines);
    const double coming =
        options.vertices > 0 ? static_cast<double>(options.vertices) : area_mm2 / std::pow(options.edge_mm, 2);
    if (coming > most_vertices)
        throw InputError(fmt::format("{} would give about {:.0f} million vertices, and {:.0f} million are made at most",
                                     options.vertices > 0 ? fmt::format("vertices {}", options.vertices)
                                                          : fmt::format("edge_mm {}", options.edge_mm),
                                     coming / 1e6, most_vertices / 1e6));
    told.edge_mm = options.edge_mm;
    auto surface = options.vertices > 0 ? with_vertices(lines, options, told.edge_mm)
                                        : remeshed(std::move(lines), options, options.edge_mm);
    for (const auto e : surface.edges()) told.mean_edge_mm += PMP::edge_length(e, surface);
    told.mean_edge_mm /= static_cast<double>(std::max<std::size_t>(1, surface.number_of_edges()));
    adapters::Remarks none;  // a map that CGAL leaves behind is none of ours
    auto result = adapters::from_cgal(surface, none);
    result.attributes.clear();
    if (report) *report = std::move(told);
    return result;
}

}  // namespace mimik::remeshing
