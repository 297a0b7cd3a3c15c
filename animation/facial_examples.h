#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "io/mesh_io.h"

namespace mimik::animation {

/// A face that shows something: what expression mapping blends.
struct FacialExample {
    std::string name;                               ///< "smile"; letters, digits, _ and -
    std::vector<std::string> arkit;                 ///< ARKit shapes that it stands for, mostly a left and a right one
    std::vector<geometry::Vector> displacement_mm;  ///< per vertex, from the neutral face
};

/// Examples of one character: one mesh, moved.
struct FacialExamples {
    geometry::Mesh neutral;  ///< mm
    std::vector<FacialExample> examples;
    /// Where features lie (animation/feature_vertices.h, and "chin"), for wires; may be empty.
    std::vector<std::pair<std::string, std::uint32_t>> feature_vertices;
    std::filesystem::path texture_file;   ///< of the neutral face; empty: none
    std::filesystem::path features_file;  ///< a table of what features do on this face; empty: none

    /// @throws InputError naming the example that does not fit the mesh, or has another's name.
    void check() const;
};

inline constexpr std::size_t most_examples = 256;
inline constexpr const char* example_list_name = "examples.toml";

/// What the list of a folder says; files are names in that folder.
struct ExampleList {
    struct Entry {
        std::string name, file;
        std::vector<std::string> arkit;
    };
    std::string neutral, texture, features;
    std::vector<Entry> entries;
    std::vector<std::pair<std::string, std::uint32_t>> feature_vertices;
};

/// The list of a folder of examples:
///
///     schema = 1
///     neutral = "neutral.ply"
///     texture = "neutral_texture.png"   # may be left out
///     features = "features.csv"         # likewise: modeling::SourceExamples of this very face
///     [[example]]
///     name = "smile"
///     file = "smile.ply"
///     arkit = ["mouthSmileLeft", "mouthSmileRight"]   # likewise
///     [feature_vertices]                # likewise: vertices of the neutral face, from 0
///     mouth_corner_left = 1200
///
/// @param name  stands for the file in errors. @throws InputError naming file, line, key and mend.
[[nodiscard]] ExampleList decode_example_list(std::string_view text, const std::string& name);

/// Reads the list and its meshes, which share vertices and faces. @throws InputError naming what does not fit.
[[nodiscard]] FacialExamples read_facial_examples(const std::filesystem::path& folder);

/// Writes meshes and list into a folder: neutral.ply, NAME.ply and examples.toml. The texture must lie there already.
void write_facial_examples(const std::filesystem::path& folder, const FacialExamples& examples,
                           const io::MadeBy& made_by = {});

}  // namespace mimik::animation
