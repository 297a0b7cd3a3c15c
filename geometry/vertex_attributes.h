#pragma once

#include "geometry/mesh.h"

namespace mimik::geometry {

/// Adds an attribute in place of those that have its name.
void set_attribute(Mesh& mesh, VertexAttribute attribute);

}  // namespace mimik::geometry
