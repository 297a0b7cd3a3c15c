#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh.h"

namespace mimik::synthesis {

/// ICT-FaceKit's OBJ files are in centimetres; its skin comes first, then mouth, eyes and teeth.
struct IctSkin {
    std::vector<geometry::Point> vertices_mm;
    geometry::Faces faces;  ///< those with no corner behind the skin
};

/// The whole mesh, cut to its first `wanted` vertices; `name` stands for the file. @throws InputError naming what is
/// wrong.
[[nodiscard]] IctSkin decode_ict_skin(std::span<const std::uint8_t> bytes, const std::string& name, std::size_t wanted);

/// The first `wanted` vertices, mm. `head` is the begin of the file, as many whole lines as are there.
/// @throws InputError naming the line.
[[nodiscard]] std::vector<geometry::Point> decode_ict_vertices(std::string_view head, const std::string& name,
                                                               std::size_t wanted);

}  // namespace mimik::synthesis
