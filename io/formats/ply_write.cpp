#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/formats/bytes.h"
#include "io/formats/ply.h"

namespace mimik::io::formats {

using geometry::Mesh;

namespace {

std::vector<std::string> component_names(const std::string& name, int components) {
    if (components == 1) return {name};
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(components));
    for (int c = 0; c < components; ++c)
        names.push_back(components <= 4 ? fmt::format("{}_{}", name, "xyzw"[c]) : fmt::format("{}_{}", name, c));
    return names;
}

}  // namespace

std::vector<std::string> ply_attribute_names(const Mesh& mesh) {
    std::set<std::string> taken = {"x",     "y",           "z",
                                   "nx",    "ny",          "nz",
                                   "red",   "green",       "blue",
                                   "alpha", "diffuse_red", "diffuse_green",
                                   "r",     "g",           "diffuse_blue",
                                   "b",     "texture_u",   "texture_v",
                                   "s",     "t",           "u",
                                   "v"};
    std::vector<std::string> names;
    for (const auto& attribute : mesh.attributes) {
        auto stem = attribute.name;
        for (char& c : stem)
            if (static_cast<unsigned char>(c) <= 0x20 || c == 0x7F) c = '_';
        if (stem.empty()) stem = "unnamed";
        auto name = stem;
        const auto is_taken = [&] {
            const auto parts = component_names(name, attribute.components);
            return std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return taken.contains(part); });
        };
        for (int number = 2; is_taken(); ++number) name = fmt::format("{}_{}", stem, number);
        for (auto& part : component_names(name, attribute.components)) taken.insert(std::move(part));
        names.push_back(std::move(name));
    }
    return names;
}

void encode_ply(std::ostream& out, const Mesh& mesh, const MeshWriteOptions& options) {
    const auto attribute_names = ply_attribute_names(mesh);
    const bool corner_texture = !mesh.faces.texture_corners.empty();
    const bool vertex_texture = !mesh.texture_coordinates.empty() && !corner_texture;
    std::size_t longest = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) longest = std::max(longest, mesh.faces[f].size());
    // Lists are counted in bytes, as every reader expects, unless a polygon is too large for that.
    const bool wide = longest > 255, wide_texture = 2 * longest > 255;

    std::string text = fmt::format("ply\nformat {} 1.0\ncomment lengths in millimetres\n",
                                   options.binary ? "binary_little_endian" : "ascii");
    if (options.frame) text += fmt::format("comment SPACE={}\n", to_string(*options.frame));
    for (const auto& [key, value] : options.made_by) text += fmt::format("comment {}: {}\n", key, one_line(value));
    for (const auto& texture : options.texture_files) text += fmt::format("comment TextureFile {}\n", texture);
    text += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                        mesh.vertices_mm.size());
    if (!mesh.colours.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    if (vertex_texture) text += "property double texture_u\nproperty double texture_v\n";
    for (std::size_t k = 0; k < attribute_names.size(); ++k)
        for (const auto& component : component_names(attribute_names[k], mesh.attributes[k].components))
            text += fmt::format("property double {}\n", component);
    if (mesh.faces.size() > 0) {
        text += fmt::format("element face {}\nproperty list {} int vertex_indices\n", mesh.faces.size(),
                            wide ? "int" : "uchar");
        if (corner_texture) text += fmt::format("property list {} double texcoord\n", wide_texture ? "int" : "uchar");
        if (!options.face_textures.empty()) text += "property int texnumber\n";
    }
    text += "end_header\n";

    const auto number = [&](double value, bool last = false) {
        if (options.binary)
            append(text, value);
        else
            fmt::format_to(std::back_inserter(text), "{:.17g}{}", value, last ? '\n' : ' ');
    };
    const auto integer = [&](std::size_t value, bool one_byte) {
        if (!options.binary)
            fmt::format_to(std::back_inserter(text), "{} ", value);
        else if (one_byte)
            append(text, static_cast<std::uint8_t>(value));
        else
            append(text, static_cast<std::int32_t>(value));
    };
    const auto number_of_texture = [&](std::uint32_t texture) {
        const auto value = texture == no_picture ? -1 : static_cast<std::int32_t>(texture);
        if (options.binary)
            append(text, value);
        else
            fmt::format_to(std::back_inserter(text), "{} ", value);
    };
    const auto end_row = [&] {
        if (!options.binary) text.back() = '\n';
    };
    for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
        for (const double coordinate : mesh.vertices_mm[i]) number(coordinate);
        if (!mesh.colours.empty())
            for (const auto channel : mesh.colours[i]) integer(channel, true);
        if (vertex_texture)
            for (const double coordinate : mesh.texture_coordinates[i]) number(coordinate);
        for (const auto& attribute : mesh.attributes)
            for (int c = 0; c < attribute.components; ++c)
                number(
                    attribute.values[i * static_cast<std::size_t>(attribute.components) + static_cast<std::size_t>(c)]);
        end_row();
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto face = mesh.faces[f];
        integer(face.size(), !wide);
        for (const auto corner : face) integer(corner, false);
        if (corner_texture) {
            integer(2 * face.size(), !wide_texture);
            for (std::size_t k = 0; k < face.size(); ++k)
                for (const double coordinate :
                     mesh.texture_coordinates[mesh.faces.texture_corners[mesh.faces.first[f] + k]])
                    number(coordinate);
        }
        if (!options.face_textures.empty()) number_of_texture(options.face_textures[f]);
        end_row();
    }
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

}  // namespace mimik::io::formats
