#include "io/formats/obj.h"
#include "io/mesh_io.h"
#include "io/texture_path.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto name = io::checked_texture_path(io::formats::texture_of_material(text_of(bytes), "input"), "input");
    require(name.find_first_of("\\:\n") == std::string::npos && !name.starts_with('/') &&
                ("/" + name + "/").find("/../") == std::string::npos,
            "a texture stays in its folder or below");
}

std::vector<std::string> seeds() {
    return {io::formats::material_with_texture("face 1.png"), "newmtl a\nmap_Kd -s 1 1 1 ../x.png\n"};
}

}  // namespace mimik::fuzzing
