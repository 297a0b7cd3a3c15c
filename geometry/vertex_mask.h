#pragma once

#include <cstdint>
#include <vector>

namespace mimik::geometry {

/// One per vertex: 1 for those that are meant, 0 for the others.
using VertexMask = std::vector<std::uint8_t>;

}  // namespace mimik::geometry
