#include "synthesis/ict_obj.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

constexpr std::size_t wanted = 4;

}  // namespace

/// The neutral mesh; behind an 'h' the head of a shape.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto text = text_of(bytes);
    if (text.starts_with('h')) {
        const auto vertices = synthesis::decode_ict_vertices(text.substr(1), "input", wanted);
        require(vertices.size() == wanted, "a shape has the vertices asked for");
        for (const auto& p : vertices) require(p.allFinite(), "positions are finite");
        return;
    }
    const auto skin = synthesis::decode_ict_skin(bytes, "input", wanted);
    require(skin.vertices_mm.size() == wanted, "the skin has the vertices asked for");
    require(skin.faces.size() > 0, "the skin has faces");
    for (const auto corner : skin.faces.corners) require(corner < wanted, "corners are of the skin");
    (void)geometry::triangulate(skin.faces);
}

std::vector<std::string> seeds() {
    const std::string vertices = "# head\nv 0 -2.5 11.8\nv 1 -2 1e1\n v\t1 0 9\nv 0 0 10 # c\nv 5 5 5\n";
    return {vertices + "vt 0.25 1.75\nvt -0.5 2\nf 1/1 2/2 3/1 4/2\nf 3 4 5\n", vertices + "f 1//1 2//1 -3\n",
            "h" + vertices, "hv 0 0\n"};
}

}  // namespace mimik::fuzzing
