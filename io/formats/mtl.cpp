#include "io/formats/mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/text.h"

namespace mimik::io::formats {
namespace {

constexpr std::size_t most_materials = 10'000;

/// Takes up to `most` numbers off the front; the name of an image may begin with a digit, so only whole words count.
std::array<double, 3> take_numbers(std::string_view& rest, std::size_t least, std::size_t most,
                                   std::array<double, 3> values) {
    for (std::size_t k = 0; k < most; ++k) {
        auto after = rest;
        const auto value = base::parse_double(base::next_word(after));
        if (!value && k >= least) break;
        // The last word of the line is the image, whatever it looks like.
        if (base::trimmed(after).empty()) break;
        if (value && std::isfinite(*value)) values[k] = *value;
        rest = after;
    }
    return values;
}

/// Reads the options of a map_ line; what is left is the image's name, blanks and all.
void read_map(std::string_view rest, Material& material) {
    static constexpr std::array<std::pair<std::string_view, std::size_t>, 9> words_behind = {{{"-blendu", 1},
                                                                                              {"-blendv", 1},
                                                                                              {"-bm", 1},
                                                                                              {"-boost", 1},
                                                                                              {"-cc", 1},
                                                                                              {"-clamp", 1},
                                                                                              {"-imfchan", 1},
                                                                                              {"-mm", 2},
                                                                                              {"-texres", 1}}};
    Material read;
    for (rest = base::trimmed(rest); rest.starts_with('-'); rest = base::trimmed(rest)) {
        auto after = rest;
        const auto option = base::lower_case(base::next_word(after));
        if (option == "-s" || option == "-o" || option == "-t") {
            const bool scale = option == "-s";
            const double nothing = scale ? 1.0 : 0.0;
            const auto xyz = take_numbers(after, 1, 3, {nothing, nothing, nothing});
            if (option != "-t") (scale ? read.scale : read.offset) = {xyz[0], xyz[1]};
        } else if (option == "-type") {
            (void)base::next_word(after);
        } else {
            const auto* known = std::find_if(words_behind.begin(), words_behind.end(),
                                             [&](const auto& entry) { return entry.first == option; });
            if (known == words_behind.end()) break;  // a name that begins with a dash
            for (std::size_t k = 0; k < known->second; ++k) (void)base::next_word(after);
        }
        rest = after;
    }
    if (rest.empty()) return;
    material.image = rest;
    material.scale = read.scale;
    material.offset = read.offset;
}

}  // namespace

std::vector<Material> decode_materials(std::string_view mtl, const std::string& name) {
    std::vector<Material> materials;
    bool diffuse = false;  // the material has its map_Kd
    base::LineReader lines(mtl, name);
    while (lines.next()) {
        std::string_view rest = lines.line();
        const auto keyword = base::lower_case(base::next_word(rest));
        if (keyword == "newmtl") {
            if (materials.size() == most_materials) break;
            materials.emplace_back().name = base::trimmed(rest);
            diffuse = false;
        } else if (keyword == "map_kd" || keyword == "map_ka") {
            if (materials.empty()) materials.emplace_back();
            auto& material = materials.back();
            if (diffuse || (keyword == "map_ka" && !material.image.empty())) continue;
            read_map(rest, material);
            diffuse = keyword == "map_kd" && !material.image.empty();
        }
    }
    return materials;
}

}  // namespace mimik::io::formats
