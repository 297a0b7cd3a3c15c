#include "animation/face_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "animation/torn_faces.h"
#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "io/glb.h"
#include "io/image.h"
#include "io/mesh_io.h"

namespace mimik::animation {

using geometry::Mesh;
using geometry::Vector;

namespace {

enum class Positions { neutral, animated };

template <typename Value>
void keep_marked(std::vector<Value>& values, const std::vector<std::uint8_t>& marked, std::size_t per_vertex = 1) {
    std::size_t next = 0;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (marked[k / per_vertex]) values[next++] = values[k];
    values.resize(next);
}

/// Vertices that no face uses are no surface.
void drop_unused_vertices(Mesh& mesh, std::vector<std::uint32_t>& kept) {
    std::vector<std::uint8_t> used(mesh.vertices_mm.size(), 0);
    for (const auto corner : mesh.faces.corners) used[corner] = 1;
    std::vector<std::uint32_t> renamed;
    renamed.reserve(used.size());
    std::uint32_t next = 0;
    for (const auto is_used : used) renamed.push_back(is_used ? next++ : next);
    for (auto& corner : mesh.faces.corners) corner = renamed[corner];
    keep_marked(mesh.vertices_mm, used);
    keep_marked(mesh.texture_coordinates, used);
    keep_marked(kept, used);
    for (auto& attribute : mesh.attributes)
        keep_marked(attribute.values, used, static_cast<std::size_t>(attribute.components));
}

/// Per face, whether parting lips, or lids that leave an eyeball, would stretch it into a web.
/// @param kept  grid index of every vertex  @param at_any_magnitude  whatever the expressions are set to: morph targets
/// can be moved
std::vector<std::uint8_t> torn_of(const Mesh& mesh, const AnimatedFace& animated,
                                  const std::vector<std::uint32_t>& kept, bool at_any_magnitude) {
    geometry::Faces on_grid;
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        corners.clear();
        for (const auto v : mesh.faces[f]) corners.push_back(kept[v]);
        on_grid.add(corners);
    }
    return at_any_magnitude ? torn_faces_of_any_shape(animated, on_grid)
                            : torn_faces(animated, animated.field.mm, on_grid);
}

/// Leaves these faces out.
void cut_torn(Mesh& mesh, const AnimatedFace& animated, std::vector<std::uint32_t>& kept, bool at_any_magnitude) {
    if (animated.lip_sides.empty() && animated.lid_sheets.empty()) return;
    const auto is_torn = torn_of(mesh, animated, kept, at_any_magnitude);
    geometry::Faces whole;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (!is_torn[f]) whole.add(mesh.faces[f]);
    mesh.faces = std::move(whole);
    drop_unused_vertices(mesh, kept);
}

/// The grid in the frame asked for, with the displacement of its neutral vertices as an attribute, and whole.
Mesh whole_mesh(const AnimatedFace& animated, const preprocessing::Face& neutral, const ExportOptions& options,
                Positions positions, std::vector<std::uint32_t>& kept) {
    Mesh mesh = geometry::to_mesh(neutral.grid, options.bridged, &kept);
    geometry::VertexAttribute displacement{"displacement_mm", 3, {}};
    for (std::size_t k = 0; k < kept.size(); ++k) {
        Vector d = animated.field.mm[kept[k]];
        auto& position_mm = mesh.vertices_mm[k];
        if (positions == Positions::animated) position_mm += d;
        if (options.average_from_scan) {
            position_mm = *options.average_from_scan * position_mm;
            d = options.average_from_scan->linear() * d;
        }
        displacement.values.insert(displacement.values.end(), d.begin(), d.end());
    }
    mesh.attributes.insert(mesh.attributes.begin(), std::move(displacement));
    return mesh;
}

/// The same without the faces that are torn.
Mesh mesh_of(const AnimatedFace& animated, const preprocessing::Face& neutral, const ExportOptions& options,
             Positions positions, std::vector<std::uint32_t>* kept_vertices = nullptr) {
    std::vector<std::uint32_t> kept;
    Mesh mesh = whole_mesh(animated, neutral, options, positions, kept);
    cut_torn(mesh, animated, kept, positions == Positions::neutral);
    if (kept_vertices) *kept_vertices = std::move(kept);
    return mesh;
}

/// A morph target before its vertices are gathered: displacements of the grid at weight 1, scanner frame.
struct Shape {
    NamedMagnitude name;
    const std::vector<Vector>* displacement_mm = nullptr;
};

/// The image as a PNG file; none if there is none, or it cannot be read: the face goes without.
std::vector<std::uint8_t> texture_png(const std::filesystem::path& texture_file, std::vector<std::string>& remarks) {
    if (texture_file.empty()) return {};
    try {
        return io::read_as_png(texture_file);
    } catch (const InputError& e) {
        remarks.push_back(fmt::format("the face has no picture: {}", e.what()));
        return {};
    }
}

/// The morph targets of an animated face: one per expression, or the resultant alone.
std::vector<Shape> morph_shapes(const std::filesystem::path& file, const AnimatedFace& animated,
                                std::span<const NamedMagnitude> names, std::vector<std::string>& remarks) {
    if (names.size() != animated.shapes.size())
        throw InputError(fmt::format("{}: {} for {} expressions; give each morph target its name", file.string(),
                                     base::counted(names.size(), "name"), animated.shapes.size()));
    std::vector<Shape> shapes;
    if (animated.combination == Combination::parallel && names.size() > 1) {
        // Viewers add morph targets up, whatever was asked for.
        std::vector<std::string> parts;
        for (const auto& name : names) parts.push_back(name.name);
        const auto joined = fmt::format("{}", fmt::join(parts, "+"));
        shapes.push_back({{joined, 1.0, {}}, &animated.field.mm});
        remarks.push_back(fmt::format("morph targets of a GLB add up, so the parallel resultant is one, {}", joined));
        return shapes;
    }
    std::set<std::string> taken;
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (!taken.insert(names[k].name).second)
            throw InputError(fmt::format("{}: two morph targets would be called {}; give each expression once",
                                         file.string(), names[k].name));
        shapes.push_back({names[k], &animated.shapes[k].mm});
    }
    return shapes;
}

std::vector<std::string> write_glb_face(const std::filesystem::path& file, const AnimatedFace& animated,
                                        const preprocessing::Face& neutral, std::span<const NamedMagnitude> names,
                                        const std::filesystem::path& texture_file, const ExportOptions& options) {
    std::vector<std::string> remarks;
    const auto shapes = morph_shapes(file, animated, names, remarks);
    std::vector<std::uint32_t> kept, source;
    const auto resting = mesh_of(animated, neutral, options, Positions::neutral, &kept);
    auto mesh = io::glb_mesh(resting, &source);
    mesh.name = neutral.id.subject;
    if (!mesh.texture_coordinates.empty()) mesh.texture_png = texture_png(texture_file, remarks);
    mesh.asset_extras = options.made_by;
    const Eigen::Matrix3d turn = options.average_from_scan ? Eigen::Matrix3d(options.average_from_scan->linear())
                                                           : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    for (const auto& shape : shapes) {
        io::MorphTarget morph{shape.name.name, {}, shape.name.magnitude, shape.name.arkit_shape};
        for (const auto v : source) morph.displacement_mm.push_back(turn * (*shape.displacement_mm)[kept[v]]);
        mesh.morph_targets.push_back(std::move(morph));
    }
    io::write_glb(file, mesh);
    return remarks;
}

/// Attributes as a table, a row per vertex; PLY names their components likewise.
void write_vertex_values(const std::filesystem::path& file, const Mesh& mesh) {
    constexpr std::array axes = {"_x", "_y", "_z"};
    base::write_atomically(file, [&](std::ostream& out) {
        out << "vertex";
        for (const auto& attribute : mesh.attributes)
            for (int c = 0; c < attribute.components; ++c)
                out << ',' << attribute.name << (attribute.components > 1 ? axes.at(static_cast<std::size_t>(c)) : "");
        out << '\n';
        for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) {
            out << v + 1;
            for (const auto& attribute : mesh.attributes) {
                const auto per_vertex = static_cast<std::size_t>(attribute.components);
                for (std::size_t c = 0; c < per_vertex; ++c)
                    out << fmt::format(",{:.17g}", attribute.values[v * per_vertex + c]);
            }
            out << '\n';
        }
    });
}

}  // namespace

std::filesystem::path vertex_values_file(const std::filesystem::path& file) {
    if (base::lower_case(file.extension().string()) != ".obj") return {};
    return file.parent_path() / (file.stem().string() + "_vertices.csv");
}

Mesh to_mesh(const AnimatedFace& animated, const preprocessing::Face& neutral, const ExportOptions& options,
             std::vector<std::uint32_t>* kept_vertices) {
    return mesh_of(animated, neutral, options, Positions::animated, kept_vertices);
}

Mesh resting_mesh(const AnimatedFace& animated, const preprocessing::Face& neutral, const ExportOptions& options,
                  std::vector<std::uint32_t>* kept_vertices) {
    return mesh_of(animated, neutral, options, Positions::neutral, kept_vertices);
}

OpenableSurface opening_mesh(const AnimatedFace& animated, const preprocessing::Face& neutral,
                             const ExportOptions& options) {
    std::vector<std::uint32_t> kept;
    const auto mesh = whole_mesh(animated, neutral, options, Positions::neutral, kept);
    std::vector<std::uint32_t> sheet(mesh.vertices_mm.size(), 0);
    for (std::size_t v = 0; v < sheet.size(); ++v) {
        if (!animated.lip_sides.empty()) sheet[v] = static_cast<std::uint32_t>(animated.lip_sides[kept[v]]);
        if (!animated.lid_sheets.empty()) sheet[v] += 4 * static_cast<std::uint32_t>(animated.lid_sheets[kept[v]]);
    }
    auto surface = open_between_sheets(mesh, torn_of(mesh, animated, kept, true), sheet);
    for (auto& v : surface.moves_with) v = kept[v];
    return surface;
}

std::vector<std::string> write_animated_face(const std::filesystem::path& file, const AnimatedFace& animated,
                                             const preprocessing::Face& neutral, std::span<const NamedMagnitude> names,
                                             const std::filesystem::path& texture_file, const ExportOptions& options) {
    const auto extension = base::lower_case(file.extension().string());
    if (extension == ".glb") return write_glb_face(file, animated, neutral, names, texture_file, options);
    if (extension != ".ply" && extension != ".obj" && extension != ".vtp")
        throw InputError(fmt::format("{}: an animated face is written as .ply, .obj, .vtp or .glb, not '{}'",
                                     file.string(), extension));
    io::MeshWriteOptions write_options;
    write_options.made_by = options.made_by;
    std::vector<std::string> remarks;
    if (const auto bytes = texture_png(texture_file, remarks); !bytes.empty()) {
        // Not face.png: that may be somebody's picture of the face.
        const auto copy = file.parent_path() / (file.stem().string() + "_texture.png");
        base::write_atomically(copy, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
        write_options.texture_file = copy.filename().string();
    }
    const auto mesh = to_mesh(animated, neutral, options);
    if (const auto values = vertex_values_file(file); !values.empty()) {
        write_vertex_values(values, mesh);
        remarks.push_back(
            fmt::format("an OBJ holds no values per vertex: displacement and origin are in {}", values.string()));
    }
    io::write_mesh(file, mesh, write_options);
    return remarks;
}

std::vector<std::string> write_animated_mesh(const std::filesystem::path& file, const AnimatedFace& animated,
                                             const Mesh& mesh, std::span<const NamedMagnitude> names,
                                             const std::filesystem::path& texture_file, const io::MadeBy& made_by) {
    std::vector<std::string> remarks;
    const auto shapes = morph_shapes(file, animated, names, remarks);
    std::vector<std::uint32_t> source;
    auto glb = io::glb_mesh(mesh, &source);
    glb.name = file.stem().string();
    if (!glb.texture_coordinates.empty()) glb.texture_png = texture_png(texture_file, remarks);
    glb.asset_extras = made_by;
    std::erase_if(glb.attributes, [&](const geometry::VertexAttribute& attribute) {
        const bool fits = std::all_of(attribute.values.begin(), attribute.values.end(),
                                      [](double value) { return std::isfinite(static_cast<float>(value)); });
        if (!fits)
            remarks.push_back(fmt::format("{}: attribute '{}' is left out: a GLB holds finite 32-bit numbers alone",
                                          file.string(), attribute.name));
        return !fits;
    });
    for (const auto& shape : shapes) {
        io::MorphTarget morph{shape.name.name, {}, shape.name.magnitude, shape.name.arkit_shape};
        for (const auto v : source) morph.displacement_mm.push_back((*shape.displacement_mm)[v]);
        glb.morph_targets.push_back(std::move(morph));
    }
    io::write_glb(file, glb);
    return remarks;
}

}  // namespace mimik::animation
