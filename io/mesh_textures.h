#pragma once

#include <filesystem>

#include "io/mesh_io.h"

namespace mimik::io {

/// The names of images and materials that decode_mesh gave become paths of images from the folder of `file`, and what
/// cannot be found or used is said in `texture_error` and `remarks`. Reads an OBJ's material files; an OBJ without
/// usemtl has the first image of them.
void find_textures(MeshFile& content, MeshFormat format, const std::filesystem::path& file);

}  // namespace mimik::io
