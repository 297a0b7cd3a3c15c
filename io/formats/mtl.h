#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/types.h"

namespace mimik::io::formats {

/// What an MTL file says of one material's picture.
struct Material {
    std::string name;
    std::string image;  ///< map_Kd as written (map_Ka where there is none), without its options; empty: none
    geometry::TextureCoordinate scale = {1.0, 1.0},
                                offset = {0.0, 0.0};  ///< options -s and -o: s * uv + o is looked up

    [[nodiscard]] bool moves_texture() const { return scale.x() != 1.0 || scale.y() != 1.0 || !offset.isZero(0.0); }
};

/// The materials of an MTL file in its order. What stands before the first newmtl is a material without a name. At most
/// 10,000. `name` stands for the file in messages.
[[nodiscard]] std::vector<Material> decode_materials(std::string_view mtl, const std::string& name);

}  // namespace mimik::io::formats
