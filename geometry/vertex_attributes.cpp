#include "geometry/vertex_attributes.h"

#include <utility>

namespace mimik::geometry {

void set_attribute(Mesh& mesh, VertexAttribute attribute) {
    std::erase_if(mesh.attributes, [&](const VertexAttribute& other) { return other.name == attribute.name; });
    mesh.attributes.push_back(std::move(attribute));
}

}  // namespace mimik::geometry
