#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::io {

/// A shape that a viewer blends in with a weight from 0 to 1.
struct MorphTarget {
    std::string name;                               ///< shown by viewers, e.g. "AU12_L" or an ARKit name
    std::vector<geometry::Vector> displacement_mm;  ///< one per vertex, at weight 1
    double weight = 0.0;                            ///< that the file opens with
    std::string arkit_name = {};                    ///< of the same shape in ARKit; empty: none
};

/// Weights of the morph targets over time; a viewer goes straight from one frame to the next.
struct WeightAnimation {
    std::string name = "performance";
    std::vector<double> times_s;  ///< from 0 on, each later than the one before
    std::vector<double> weights;  ///< frame after frame, one per morph target
};

struct GlbMesh {
    std::string name = "face";
    std::vector<geometry::Point> positions_mm;
    std::vector<geometry::Vector> normals;  ///< empty: computed from the triangles
    /// Empty, or one per vertex, v up as everywhere in Mimik.
    std::vector<geometry::TextureCoordinate> texture_coordinates;
    std::vector<std::array<std::uint8_t, 3>> colours;  ///< empty, or RGB per vertex; left out beside a texture
    std::vector<geometry::Triangle> triangles;
    std::vector<std::uint8_t> texture_png;  ///< a PNG file, embedded; empty: plain skin colour
    std::vector<MorphTarget> morph_targets;
    /// Kept as the application's own: "origin" as _ORIGIN; 1 to 4 components.
    std::vector<geometry::VertexAttribute> attributes;
    std::vector<std::pair<std::string, std::string>> extras;        ///< kept in mesh.extras beside targetNames
    std::vector<std::pair<std::string, std::string>> asset_extras;  ///< kept in asset.extras, e.g. the target's name
    std::optional<WeightAnimation> animation = {};                  ///< one channel; none: a face at rest
};

/// glTF asks no more of viewers than 8 morph targets at once, and engines hold few hundred.
inline constexpr std::size_t most_active_targets = 8, most_animated_targets = 256;

/// One mesh as glTF 2.0, binary: metres, v counted downward, 32-bit floats. Vertices that no triangle uses are left out
/// (so bridged or outside vertices may hold NaN). Morph targets carry the change of the normals too;
/// mesh.extras.targetNames names them; if ARKit has any of them, mesh.extras.arkitNames has its names in the same
/// order, "" where there is none. Attributes are written in their own units under their names in capitals after an
/// underscore, as glTF asks. A mesh that reaches further than 10 m from the origin stands in a node with a translation
/// of whole metres, so that its 32-bit positions keep their 0.001 mm. A picture repeats where positions leave [0, 1].
/// An animation is one channel of weights with its times in seconds; it moves at most 256 targets.
/// @throws InputError naming the mesh and the part that does not fit; NumericalError for what is not finite in 32 bits.
[[nodiscard]] std::vector<std::uint8_t> encode_glb(const GlbMesh& mesh);
void write_glb(const std::filesystem::path& file, const GlbMesh& mesh);

/// What a user should hear of an animation: more than 8 targets that are active at once in some frame, of which some
/// viewers show only the 8 largest. Empty: nothing.
[[nodiscard]] std::vector<std::string> animation_remarks(const GlbMesh& mesh);

/// Triangulated mesh with one texture position per vertex: a vertex on a texture seam becomes several. Colours and
/// attributes go along. `source_vertex` (if asked for) says which vertex of `mesh` each comes from, to carry
/// displacements along.
[[nodiscard]] GlbMesh glb_mesh(const geometry::Mesh& mesh, std::vector<std::uint32_t>* source_vertex = nullptr);

}  // namespace mimik::io
