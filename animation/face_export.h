#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "animation/animate.h"
#include "animation/open_inside.h"
#include "geometry/mesh.h"
#include "io/mesh_io.h"
#include "preprocessing/face.h"

namespace mimik::animation {

struct ExportOptions {
    std::optional<geometry::Transform> average_from_scan = {};  ///< set: in the average frame; else in the scanner's
    geometry::BridgedVertices bridged = geometry::BridgedVertices::leave_out;  ///< quads over holes: not measurements
    io::MadeBy made_by = {};  ///< kept in the file: comments of PLY and OBJ, field data of VTP, asset.extras of GLB

    static constexpr std::size_t unlisted = 2;  // average_from_scan, made_by
    template <class Self, class Visit>
    static constexpr void each_field(Self& self, Visit&& visit) {
        visit("bridged", self.bridged);
    }
};

/// The animated face of a scan as a mesh: quads of the grid, texture coordinates, attributes `displacement_mm` (3 per
/// vertex, in the frame of the mesh) and `origin` (1 measured, 2 bridged). Vertices outside the face (and bridged ones,
/// if they are left out) are dropped, and so are faces between lips or lids that part and what they alone use; the
/// order of the rest is kept.
/// @param kept_vertices  grid index of every vertex of the mesh
[[nodiscard]] geometry::Mesh to_mesh(const AnimatedFace& animated, const preprocessing::Face& neutral,
                                     const ExportOptions& options = {},
                                     std::vector<std::uint32_t>* kept_vertices = nullptr);

/// The same at rest, without the faces that any of the `shapes` tears: what morph targets can be put on.
[[nodiscard]] geometry::Mesh resting_mesh(const AnimatedFace& animated, const preprocessing::Face& neutral,
                                          const ExportOptions& options = {},
                                          std::vector<std::uint32_t>* kept_vertices = nullptr);

/// The same, whole: where the shapes tear it, it is cut, and a dark inside lies behind the cut (open_inside.h). No
/// colours yet. `moves_with` are grid indices.
[[nodiscard]] OpenableSurface opening_mesh(const AnimatedFace& animated, const preprocessing::Face& neutral,
                                           const ExportOptions& options = {});

/// One morph target of the GLB: an expression at magnitude 1 and how far it is set.
struct NamedMagnitude {
    std::string name;  ///< "AU12_L" or the ARKit name
    double magnitude = 1.0;
    std::string arkit_shape = {};  ///< kept beside the name; empty: ARKit has none
};

/// Where the attributes of an animated face lie that is written as `file`: beside face.obj in face_vertices.csv; empty
/// for the other formats, which hold them.
[[nodiscard]] std::filesystem::path vertex_values_file(const std::filesystem::path& file);

/// Writes .ply, .obj, .vtp (the animated face; texture of face.ply copied beside it as face_texture.png) or .glb (the
/// neutral face with one morph target per expression set to its magnitude, metres, texture embedded). Morph targets add
/// up, so several expressions combined in parallel are one target, the resultant, "AU12+AU4". The attributes of to_mesh
/// go along: in a .glb as _DISPLACEMENT_MM (of all expressions as they are set) and _ORIGIN, of an .obj in a table
/// beside it (vertex_values_file).
/// @param neutral  what was animated
/// @param texture_file  PNG, JPEG or BMP of the scan; empty: none. One that cannot be read is left out, with a remark.
/// @param names  one per expression, in the order of `animated.shapes`; used by GLB only.
/// @return remarks: what the file cannot hold as it was asked for.
/// @throws InputError for another extension, equal names of morph targets, or if the file cannot be written.
std::vector<std::string> write_animated_face(const std::filesystem::path& file, const AnimatedFace& animated,
                                             const preprocessing::Face& neutral, std::span<const NamedMagnitude> names,
                                             const std::filesystem::path& texture_file,
                                             const ExportOptions& options = {});

/// Anybody's mesh at rest as .glb, with morph targets as write_animated_face: blendshapes for any viewer.
/// @param mesh  what was animated (animate_mesh): its topology, texture positions and attributes are kept
/// @return, @throws as write_animated_face
std::vector<std::string> write_animated_mesh(const std::filesystem::path& file, const AnimatedFace& animated,
                                             const geometry::Mesh& mesh, std::span<const NamedMagnitude> names,
                                             const std::filesystem::path& texture_file, const io::MadeBy& made_by = {});

}  // namespace mimik::animation
