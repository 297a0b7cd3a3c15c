#include "io/mesh_io.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <new>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "io/formats/obj.h"
#include "io/formats/pcd.h"
#include "io/formats/ply.h"
#include "io/formats/stl.h"
#include "io/formats/vtp.h"
#include "io/mesh_textures.h"
#include "io/texture_path.h"

namespace mimik::io {

using geometry::Mesh;

namespace {

void scale_lengths(MeshFile& file, LengthUnit unit) {
    if (unit == LengthUnit::millimetre) return;
    for (auto& p : file.mesh.vertices_mm) p *= millimetres_per(unit);
}

/// A lattice keeps its points without a position; elsewhere they go, unless they are part of the surface.
void settle_vertices(MeshFile& file, MeshFormat format, const std::string& name) {
    const auto& vertices = file.mesh.vertices_mm;
    if (vertices.empty()) throw InputError(fmt::format("{}: there is no vertex in it; is it the right file?", name));
    if (format == MeshFormat::pcd) return;
    for (const auto i : file.mesh.faces.corners)
        if (!vertices[i].allFinite())
            throw InputError(
                fmt::format("{}: vertex {} (counted from 0) is a corner of a face and is ({}, {}, {}), not a finite "
                            "position; delete it or export the mesh again",
                            name, i, vertices[i].x(), vertices[i].y(), vertices[i].z()));
    drop_unmeasured(file, name);
}

/// The surface does not need its texture: a position that is no number becomes (0, 0).
void mend_texture(MeshFile& file, const std::string& name) {
    std::size_t mended = 0;
    for (std::size_t i = 0; i < file.mesh.texture_coordinates.size(); ++i) {
        auto& position = file.mesh.texture_coordinates[i];
        // A point of a lattice that was not measured has no texture either.
        const bool unmeasured = file.rows > 0 && !file.mesh.vertices_mm[i].allFinite();
        if (position.allFinite() || unmeasured) continue;
        position.setZero();
        ++mended;
    }
    if (mended > 0)
        file.remarks.push_back(fmt::format("{}: {} (0, 0)", name,
                                           base::counted(mended, "texture position is not finite; it becomes",
                                                         "texture positions are not finite; they become")));
}

/// Attributes have names, each another.
void name_attributes(MeshFile& file, const std::string& name) {
    std::set<std::string> taken;
    for (auto& attribute : file.mesh.attributes) {
        const auto stem = attribute.name.empty() ? std::string("unnamed") : attribute.name;
        auto unique = stem;
        for (int number = 2; !taken.insert(unique).second; ++number) unique = fmt::format("{}_{}", stem, number);
        if (unique == attribute.name) continue;
        file.remarks.push_back(
            attribute.name.empty()
                ? fmt::format("{}: a value per vertex has no name; it is called {}", name, base::in_quotes(unique))
                : fmt::format("{}: two values per vertex are called {}; one becomes {}", name,
                              base::in_quotes(attribute.name), base::in_quotes(unique)));
        attribute.name = std::move(unique);
    }
}

void check_parts_fit(const Mesh& mesh, const std::string& name) {
    const auto n = mesh.vertices_mm.size();
    const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("{}: not written: {}", name, what));
    };
    if (!mesh.colours.empty() && mesh.colours.size() != n)
        refuse(fmt::format("{} for {} vertices", base::counted(mesh.colours.size(), "colour"), n));
    const auto& faces = mesh.faces;
    if (faces.texture_corners.empty()) {
        if (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != n)
            refuse(fmt::format("{} for {} vertices", base::counted(mesh.texture_coordinates.size(), "texture position"),
                               n));
    } else if (faces.texture_corners.size() != faces.corners.size()) {
        refuse(fmt::format("{} for {}", base::counted(faces.texture_corners.size(), "texture corner"),
                           base::counted(faces.corners.size(), "face corner")));
    }
    for (const auto corner : faces.corners)
        if (corner >= n) refuse(fmt::format("a face names vertex {} of {}", corner, n));
    for (const auto corner : faces.texture_corners)
        if (corner >= mesh.texture_coordinates.size())
            refuse(fmt::format("a face names texture position {} of {}", corner, mesh.texture_coordinates.size()));
    for (std::size_t k = 0; k < mesh.attributes.size(); ++k)
        for (std::size_t other = 0; other < k; ++other)
            if (mesh.attributes[k].name == mesh.attributes[other].name)
                refuse(fmt::format("two attributes are called {}; leave one out",
                                   base::in_quotes(mesh.attributes[k].name)));
    for (const auto& attribute : mesh.attributes)
        if (attribute.components < 1 || attribute.values.size() != n * static_cast<std::size_t>(attribute.components))
            refuse(fmt::format("attribute {} has {} for {} vertices of {}", base::in_quotes(attribute.name),
                               base::counted(attribute.values.size(), "value"), n,
                               base::counted(attribute.components, "component")));
    for (std::size_t i = 0; i < n; ++i)
        if (!mesh.vertices_mm[i].allFinite()) refuse(fmt::format("vertex {} is not a finite position", i));
}

MeshFile decode(MeshFormat format, std::span<const std::uint8_t> bytes, const std::string& name, MeshParts parts) {
    switch (format) {
        case MeshFormat::ply:
            return formats::decode_ply(bytes, name);
        case MeshFormat::obj:
            return formats::decode_obj(bytes, name);
        case MeshFormat::stl:
            return formats::decode_stl(bytes, name);
        case MeshFormat::pcd:
            return formats::decode_pcd(bytes, name, parts);
        case MeshFormat::vtp:
            break;
    }
    return formats::decode_vtp(bytes, name, parts);
}

}  // namespace

LengthUnit parse_length_unit(const std::string& text) {
    if (text == "mm") return LengthUnit::millimetre;
    if (text == "cm") return LengthUnit::centimetre;
    if (text == "m") return LengthUnit::metre;
    if (text == "inch") return LengthUnit::inch;
    throw InputError(fmt::format("unit {} is not known; use mm, cm, m or inch", base::in_quotes(text)));
}

const char* to_string(LengthUnit unit) {
    switch (unit) {
        case LengthUnit::millimetre:
            return "mm";
        case LengthUnit::centimetre:
            return "cm";
        case LengthUnit::inch:
            return "inch";
        case LengthUnit::metre:
            break;
    }
    return "m";
}

double millimetres_per(LengthUnit unit) {
    switch (unit) {
        case LengthUnit::millimetre:
            return 1.0;
        case LengthUnit::centimetre:
            return 10.0;
        case LengthUnit::inch:
            return 25.4;
        case LengthUnit::metre:
            break;
    }
    return 1000.0;
}

MeshFormat mesh_format(const std::filesystem::path& file) {
    const auto extension = base::lower_case(file.extension().string());
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".obj") return MeshFormat::obj;
    if (extension == ".stl") return MeshFormat::stl;
    if (extension == ".pcd") return MeshFormat::pcd;
    if (extension == ".vtp") return MeshFormat::vtp;
    throw InputError(fmt::format("{}: extension {} is no mesh format; there are .ply, .obj, .stl, .pcd and .vtp",
                                 file.string(), base::in_quotes(extension)));
}

std::string checked_texture_name(const std::string& texture, const std::string& file) {
    auto name = checked_texture_path(texture, file);
    if (name.find('/') != std::string::npos)
        throw InputError(
            fmt::format("{}: texture name is {}; it must be a bare file name: put the image beside the "
                        "mesh and name it without a folder",
                        file, base::in_quotes(texture)));
    return name;
}

MeshFile decode_mesh(MeshFormat format, std::span<const std::uint8_t> bytes, const std::string& name, LengthUnit unit,
                     MeshParts parts) {
    auto file = [&] {
        try {
            return decode(format, bytes, name, parts);
        } catch (const std::bad_alloc&) {
            throw InputError(fmt::format("{}: there is not enough memory for what it holds", name));
        } catch (const std::length_error&) {
            throw InputError(fmt::format("{}: promises more than any memory holds; its header is wrong", name));
        }
    }();
    if (parts == MeshParts::without_attributes) file.mesh.attributes.clear();
    scale_lengths(file, unit);
    settle_vertices(file, format, name);
    mend_texture(file, name);
    name_attributes(file, name);
    return file;
}

void drop_unmeasured(MeshFile& file, const std::string& name) {
    auto& mesh = file.mesh;
    const bool texture_of_corners = !mesh.faces.texture_corners.empty();
    const bool texture_of_vertices = !texture_of_corners && !mesh.texture_coordinates.empty();
    std::vector<std::uint32_t> place(mesh.vertices_mm.size(), 0);  // among those that are kept
    std::size_t kept = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (!mesh.vertices_mm[i].allFinite()) continue;
        place[i] = static_cast<std::uint32_t>(kept);
        mesh.vertices_mm[kept] = mesh.vertices_mm[i];
        if (texture_of_vertices) mesh.texture_coordinates[kept] = mesh.texture_coordinates[i];
        if (!mesh.colours.empty()) mesh.colours[kept] = mesh.colours[i];
        for (auto& attribute : mesh.attributes) {
            const auto n = static_cast<std::size_t>(attribute.components);
            for (std::size_t c = 0; c < n; ++c) attribute.values[kept * n + c] = attribute.values[i * n + c];
        }
        ++kept;
    }
    file.rows = file.cols = 0;
    const auto dropped = place.size() - kept;
    if (kept == 0) throw InputError(fmt::format("{}: every point is marked as not measured (NaN)", name));
    if (dropped == 0) return;
    for (auto& corner : mesh.faces.corners) corner = place[corner];
    mesh.vertices_mm.resize(kept);
    if (texture_of_vertices) mesh.texture_coordinates.resize(kept);
    if (!mesh.colours.empty()) mesh.colours.resize(kept);
    for (auto& attribute : mesh.attributes)
        attribute.values.resize(kept * static_cast<std::size_t>(attribute.components));
    file.remarks.push_back(fmt::format(
        "{}: {} left out", name,
        base::counted(dropped, "point that was not measured (NaN) is", "points that were not measured (NaN) are")));
}

void bring_to_lps(MeshFile& file, const std::string& name) {
    if (file.frame != BodyFrame::ras) return;
    negate_x_and_y(file.mesh.vertices_mm);
    file.frame = BodyFrame::lps;
    file.remarks.push_back(fmt::format("{}: says that it is in RAS; x and y are negated, to LPS", name));
}

Mesh read_mesh(const std::filesystem::path& file, LengthUnit unit) {
    const auto format = mesh_format(file);
    auto content = decode_mesh(format, base::read_bytes(file), file.string(), unit);
    if (format == MeshFormat::pcd) drop_unmeasured(content, file.string());
    bring_to_lps(content, file.string());
    return std::move(content.mesh);
}

MeshFile read_mesh_file(const std::filesystem::path& file, LengthUnit unit, MeshParts parts, BadTexture bad_texture) {
    const auto format = mesh_format(file);
    auto content = decode_mesh(format, base::read_bytes(file), file.string(), unit, parts);
    find_textures(content, format, file);
    if (bad_texture == BadTexture::refuse && !content.texture_error.empty()) throw InputError(content.texture_error);
    return content;
}

namespace {

MeshWriteOptions checked_options(const Mesh& mesh, const MeshWriteOptions& options, const std::string& name) {
    auto checked = options;
    if (checked.texture_files.empty() && !options.texture_file.empty()) checked.texture_files = {options.texture_file};
    for (auto& texture : checked.texture_files) texture = checked_texture_name(texture, name);
    auto& pictures = checked.face_textures;
    if (checked.texture_files.empty()) pictures.clear();
    if (!pictures.empty() && pictures.size() != mesh.faces.size())
        throw InputError(
            fmt::format("{}: not written: images of {} faces, of {}", name, pictures.size(), mesh.faces.size()));
    for (const auto picture : pictures)
        if (picture != no_picture && picture >= checked.texture_files.size())
            throw InputError(
                fmt::format("{}: not written: a face has image {} of {}", name, picture, checked.texture_files.size()));
    return checked;
}

/// What the format has no place for.
std::vector<std::string> left_out_by(MeshFormat format, const Mesh& mesh, const std::string& name) {
    std::vector<std::string> parts;
    const bool stl = format == MeshFormat::stl;
    if (stl && !mesh.colours.empty()) parts.emplace_back("colours");
    if (stl && !mesh.texture_coordinates.empty()) parts.emplace_back("texture positions");
    if (stl || format == MeshFormat::obj)
        for (const auto& attribute : mesh.attributes) parts.push_back(base::in_quotes(attribute.name));
    std::vector<std::string> remarks;
    if (!parts.empty())
        remarks.push_back(fmt::format("{}: the format has no place for {}; left out (.ply and .vtp keep them)", name,
                                      fmt::join(parts, ", ")));
    const bool ply = format == MeshFormat::ply;
    if (ply || format == MeshFormat::vtp) {
        const auto names = ply ? formats::ply_attribute_names(mesh) : formats::vtp_attribute_names(mesh);
        for (std::size_t k = 0; k < names.size(); ++k)
            if (names[k] != mesh.attributes[k].name)
                remarks.push_back(fmt::format("{}: {} is called {}, since the format cannot hold that name", name,
                                              base::in_quotes(mesh.attributes[k].name), base::in_quotes(names[k])));
    }
    if (stl) {
        double largest = 0;
        for (const auto& p : mesh.vertices_mm) largest = std::max(largest, p.cwiseAbs().maxCoeff());
        const auto single = static_cast<float>(largest);
        const double step = static_cast<double>(std::nextafter(single, std::numeric_limits<float>::max())) - single;
        if (constexpr double told_mm = 1e-3; step / 2 > told_mm)
            remarks.push_back(
                fmt::format("{}: coordinates reach {:.0f}, where the 32-bit numbers of STL lose up to {:.2g} mm; write "
                            ".ply, or move the mesh to the origin first",
                            name, largest, step / 2));
    }
    return remarks;
}

}  // namespace

std::string encode_ply(const Mesh& mesh, const std::string& name, const MeshWriteOptions& options) {
    check_parts_fit(mesh, name);
    std::ostringstream out;
    out.imbue(std::locale::classic());
    formats::encode_ply(out, mesh, checked_options(mesh, options, name));
    return std::move(out).str();
}

std::vector<std::string> write_mesh(const std::filesystem::path& file, const Mesh& mesh,
                                    const MeshWriteOptions& options) {
    const auto format = mesh_format(file);
    check_parts_fit(mesh, file.string());
    const auto checked = checked_options(mesh, options, file.string());
    std::vector<std::string> remarks = left_out_by(format, mesh, file.string());
    switch (format) {
        case MeshFormat::ply:
            base::write_atomically(file, [&](std::ostream& out) { formats::encode_ply(out, mesh, checked); });
            return remarks;
        case MeshFormat::obj: {
            std::string material;
            if (!checked.texture_files.empty()) {
                material = file.stem().string() + ".mtl";
                auto material_file = file;
                base::write_atomically(material_file.replace_filename(material), formats::encode_materials(checked));
            }
            base::write_atomically(file, [&](std::ostream& out) { formats::encode_obj(out, mesh, checked, material); });
            return remarks;
        }
        case MeshFormat::stl:
            base::write_atomically(file,
                                   [&](std::ostream& out) { formats::encode_stl(out, mesh, checked, file.string()); });
            return remarks;
        case MeshFormat::vtp:
            base::write_atomically(
                file, [&](std::ostream& out) { formats::encode_vtp(out, mesh, checked.made_by, checked.frame); });
            return remarks;
        case MeshFormat::pcd:
            break;
    }
    throw InputError(fmt::format("{}: .pcd is read but not written; write .ply, .obj, .stl or .vtp", file.string()));
}

}  // namespace mimik::io
