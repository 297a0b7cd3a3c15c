#include "io/formats/mtl.h"
#include "io/formats/obj.h"
#include "io/texture_path.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {

void fuzz_one(std::span<const std::uint8_t> bytes) {
    for (const auto& material : io::formats::decode_materials(text_of(bytes), "input")) {
        require(material.scale.allFinite() && material.offset.allFinite(), "a picture is moved by finite numbers");
        const auto found = io::find_beside("/nowhere", material.image);
        require(found.empty(), "nothing lies in a folder that is not there");
        const auto name = io::checked_texture_path(material.image, "input");
        require(name.find_first_of("\\:\n") == std::string::npos && !name.starts_with('/') &&
                    ("/" + name + "/").find("/../") == std::string::npos,
                "a texture stays in its folder or below");
    }
}

std::vector<std::string> seeds() {
    io::MeshWriteOptions options;
    options.texture_files = {"face 1.png", "b.png"};
    return {io::formats::encode_materials(options), "newmtl a\nmap_Kd -s 1 1 1 -o 0 0 -bm 0.5 ../x.png\n",
            "map_Ka C:\\a\\b c.png\nnewmtl b\nmap_Kd -clamp on \"d.png\"\n"};
}

}  // namespace mimik::fuzzing
