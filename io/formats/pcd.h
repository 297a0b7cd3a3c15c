#pragma once

#include "io/mesh_io.h"

namespace mimik::io::formats {

/// PCD v0.7 (and older): fields x y z, rgb or rgba, u v; normals are passed over, every other field becomes an
/// attribute. DATA ascii, binary or binary_compressed (LZF). HEIGHT > 1 gives rows and cols in the file's order; a
/// point with a coordinate that is not finite is kept as NaN. File's own unit.
[[nodiscard]] MeshFile decode_pcd(std::span<const std::uint8_t> bytes, const std::string& name,
                                  MeshParts parts = MeshParts::all);

}  // namespace mimik::io::formats
