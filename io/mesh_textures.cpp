#include "io/mesh_textures.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "io/formats/mtl.h"
#include "io/texture_path.h"

namespace mimik::io {

namespace fs = std::filesystem;
using formats::Material;
using geometry::TextureCoordinate;

namespace {

constexpr std::uintmax_t most_material_bytes = std::uintmax_t{1} << 24;

/// Where a named image is, or where it should be. @throws InputError if no file may have that name.
std::string place_of(const fs::path& folder, const std::string& written, const std::string& named_by) {
    if (auto path = find_beside(folder, written); !path.empty()) return path;
    return checked_texture_path(written, named_by);
}

/// A material and the image that it has, from the mesh's folder; empty: none.
struct PlacedMaterial {
    Material material;
    std::string library;  ///< that it stands in, for messages
    fs::path folder;      ///< of the library, from the mesh's folder
};

/// The files that a mtllib line names: one name with blanks, or several of which each ends with .mtl.
std::vector<std::string> library_names(const fs::path& folder, const std::string& written) {
    if (!find_beside(folder, written).empty()) return {written};
    std::vector<std::string> names;
    std::string name;
    for (std::string_view rest = written, word = base::next_word(rest); !word.empty(); word = base::next_word(rest)) {
        name += (name.empty() ? "" : " ") + std::string(word);
        if (!base::lower_case(word).ends_with(".mtl")) continue;
        names.push_back(std::move(name));
        name.clear();
    }
    if (!name.empty()) names.push_back(std::move(name));
    return names;
}

/// Finds the libraries of an OBJ and reads them. One that is not there takes pictures away, not the mesh.
std::vector<PlacedMaterial> read_libraries(MeshFile& content, const fs::path& file) {
    std::vector<PlacedMaterial> materials;
    const auto folder = file.parent_path();
    for (const auto& written : std::exchange(content.material_files, {}))
        for (const auto& name : library_names(folder, written)) {
            const auto path = find_beside(folder, name);
            if (path.empty()) {
                try {
                    content.material_files.push_back(checked_texture_path(name, file.string()));
                } catch (const InputError& e) {
                    if (content.texture_error.empty()) content.texture_error = e.what();
                    continue;
                }
                if (!content.mesh.texture_coordinates.empty())
                    content.remarks.push_back(
                        fmt::format("{}: material file {} is not beside it, so its pictures are "
                                    "left out",
                                    file.string(), base::in_quotes(name)));
                continue;
            }
            content.material_files.push_back(path);
            const auto library = (folder / path).string();
            for (auto& material : formats::decode_materials(base::read_text(library, most_material_bytes), library))
                materials.push_back({std::move(material), library, fs::path(path).parent_path()});
        }
    return materials;
}

const PlacedMaterial* material_called(const std::vector<PlacedMaterial>& materials, std::string_view name) {
    for (const auto& placed : materials)
        if (placed.material.name == name) return &placed;
    for (const auto& placed : materials)
        if (base::equal_ignoring_case(placed.material.name, name)) return &placed;
    return nullptr;
}

/// Without usemtl, the first picture that there is.
const PlacedMaterial* first_with_image(const std::vector<PlacedMaterial>& materials) {
    for (const auto& placed : materials)
        if (!placed.material.image.empty()) return &placed;
    return nullptr;
}

/// The image of a material from the mesh's folder, found beside its library or beside the mesh.
std::string image_of(const PlacedMaterial& placed, const fs::path& mesh_folder) {
    const auto& written = placed.material.image;
    if (auto path = find_beside(mesh_folder / placed.folder, written); !path.empty())
        return (placed.folder / path).generic_string();
    if (auto path = find_beside(mesh_folder, written); !path.empty()) return path;
    return (placed.folder / checked_texture_path(written, placed.library)).generic_string();
}

/// Texture positions of the faces whose material moves its picture (-s, -o).
void move_texture(MeshFile& content, const std::vector<const Material*>& of_face) {
    auto& mesh = content.mesh;
    auto& faces = mesh.faces;
    if (mesh.texture_coordinates.empty()) return;
    if (std::none_of(of_face.begin(), of_face.end(), [](const auto* m) { return m && m->moves_texture(); })) return;
    if (faces.texture_corners.empty()) faces.texture_corners = faces.corners;
    std::map<std::pair<const Material*, std::uint32_t>, std::uint32_t> moved;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto* material = of_face[f];
        if (!material || !material->moves_texture()) continue;
        for (auto k = faces.first[f]; k < faces.first[f + 1]; ++k) {
            auto& corner = faces.texture_corners[k];
            const auto [entry, added] = moved.try_emplace(std::pair(material, corner),
                                                          static_cast<std::uint32_t>(mesh.texture_coordinates.size()));
            if (added) {
                const TextureCoordinate uv = mesh.texture_coordinates[corner];
                mesh.texture_coordinates.emplace_back(material->scale.cwiseProduct(uv) + material->offset);
            }
            corner = entry->second;
        }
    }
}

/// Materials in use become images.
void use_materials(MeshFile& content, const fs::path& file) {
    const auto names = std::exchange(content.texture_files, {});
    const auto material_of_face = std::exchange(content.face_textures, {});
    const auto materials = read_libraries(content, file);
    if (materials.empty()) return;
    std::vector<const PlacedMaterial*> used;
    if (names.empty()) used.push_back(first_with_image(materials));
    for (const auto& name : names) {
        used.push_back(material_called(materials, name));
        if (!used.back())
            content.remarks.push_back(
                fmt::format("{}: material {} is in no material file of it; its faces have no picture", file.string(),
                            base::in_quotes(name)));
    }
    std::vector<std::uint32_t> image_of_material;
    for (const auto* placed : used) {
        image_of_material.push_back(no_picture);
        if (!placed || placed->material.image.empty()) continue;
        try {
            content.texture_files.push_back(image_of(*placed, file.parent_path()));
            image_of_material.back() = static_cast<std::uint32_t>(content.texture_files.size() - 1);
        } catch (const InputError& e) {
            if (content.texture_error.empty()) content.texture_error = e.what();
        }
    }
    std::vector<const Material*> of_face;
    for (std::size_t f = 0; f < content.mesh.faces.size(); ++f) {
        const auto material = names.empty() ? 0U : material_of_face[f];
        const bool known = material != no_picture;
        content.face_textures.push_back(known ? image_of_material[material] : no_picture);
        of_face.push_back(known && used[material] ? &used[material]->material : nullptr);
    }
    move_texture(content, of_face);
}

void place_images(MeshFile& content, const fs::path& file) {
    std::vector<std::uint32_t> new_number;
    for (const auto& written : std::exchange(content.texture_files, {})) {
        new_number.push_back(no_picture);
        try {
            content.texture_files.push_back(place_of(file.parent_path(), written, file.string()));
            new_number.back() = static_cast<std::uint32_t>(content.texture_files.size() - 1);
        } catch (const InputError& e) {
            if (content.texture_error.empty()) content.texture_error = e.what();
        }
    }
    if (new_number.empty()) return;
    if (content.face_textures.empty()) content.face_textures.assign(content.mesh.faces.size(), 0);
    for (auto& picture : content.face_textures)
        if (picture != no_picture) picture = new_number[picture];
}

/// Each image once, in the order of the faces that have them; those that no face has are left out.
void keep_used_images(MeshFile& content) {
    auto& pictures = content.face_textures;
    if (pictures.empty() && !content.texture_files.empty()) content.texture_files.resize(1);  // of a cloud
    std::map<std::string, std::uint32_t> number;
    std::vector<std::string> used;
    for (auto& picture : pictures) {
        if (picture == no_picture) continue;
        const auto& image = content.texture_files[picture];
        const auto [entry, added] = number.try_emplace(image, static_cast<std::uint32_t>(used.size()));
        if (added) used.push_back(image);
        picture = entry->second;
    }
    if (!pictures.empty()) content.texture_files = std::move(used);
    if (std::all_of(pictures.begin(), pictures.end(), [](auto picture) { return picture == 0; })) pictures.clear();
    if (content.texture_files.empty()) pictures.clear();
    content.texture_file = content.texture_files.size() == 1 ? content.texture_files.front() : std::string();
}

}  // namespace

void find_textures(MeshFile& content, MeshFormat format, const fs::path& file) {
    if (format == MeshFormat::obj)
        use_materials(content, file);
    else
        place_images(content, file);
    keep_used_images(content);
}

}  // namespace mimik::io
