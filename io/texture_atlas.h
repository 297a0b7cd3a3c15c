#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "io/image.h"

namespace mimik::io {

/// For what can show one picture only: the images of a mesh one above the other in one picture, and the mesh's texture
/// positions in that. Images repeat, so each face is moved by whole numbers to where it lies in its image; what of it
/// reaches beyond has the colour of the border. Faces without a picture are of plain skin colour. Images of other
/// widths are brought to the largest. An image that is missing has skin colour, too.
/// @param face_textures  which of `images` each face has; beyond them: none; empty: the first.
/// @throws InputError if the picture would have more than 100 million pixels, naming the mend.
[[nodiscard]] Image texture_atlas(geometry::Mesh& mesh, std::span<const std::optional<Image>> images,
                                  std::span<const std::uint32_t> face_textures);

}  // namespace mimik::io
