#include "io/glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "geometry/polygon_triangles.h"
#include "io/formats/bytes.h"

namespace mimik::io {

using geometry::Faces;
using geometry::Mesh;
using geometry::TextureCoordinate;
using geometry::Triangle;
using geometry::Vector;
using geometry::VertexAttribute;

namespace {

using Json = nlohmann::ordered_json;
using formats::append;

constexpr double metres_per_mm = 1e-3;
constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();
// Numbers that the glTF 2.0 specification fixes.
constexpr int type_uint8 = 5121, type_uint32 = 5125, type_float = 5126;
constexpr int target_vertices = 34962, target_indices = 34963;
constexpr std::array<const char*, 4> vector_types = {"SCALAR", "VEC2", "VEC3", "VEC4"};
constexpr std::array<std::uint8_t, 8> png_signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

Json object_of(const std::vector<std::pair<std::string, std::string>>& entries) {
    Json object = Json::object();
    for (const auto& [key, value] : entries) object[key] = value;
    return object;
}

/// The binary chunk and what the JSON says about it.
class Buffer {
public:
    /// Vectors as 32-bit floats; min and max, where asked for, are those of the rounded numbers.
    std::size_t add_floats(std::span<const Eigen::Vector3d> vectors, double scale, bool with_range) {
        const auto view = begin_view(target_vertices);
        Eigen::Vector3f smallest = Eigen::Vector3f::Constant(std::numeric_limits<float>::max()), largest = -smallest;
        for (const auto& v : vectors) {
            const Eigen::Vector3f rounded = (v * scale).cast<float>();
            for (const float x : rounded) append(bytes_, x);
            smallest = smallest.cwiseMin(rounded);
            largest = largest.cwiseMax(rounded);
        }
        Json accessor = end_view(view, type_float, "VEC3", vectors.size());
        if (with_range) {
            accessor["min"] = {smallest.x(), smallest.y(), smallest.z()};
            accessor["max"] = {largest.x(), largest.y(), largest.z()};
        }
        return keep(std::move(accessor));
    }

    std::size_t add_texture_coordinates(std::span<const TextureCoordinate> coordinates) {
        const auto view = begin_view(target_vertices);
        for (const auto& t : coordinates) {
            append(bytes_, static_cast<float>(t.x()));
            append(bytes_, static_cast<float>(1.0 - t.y()));
        }
        return keep(end_view(view, type_float, "VEC2", coordinates.size()));
    }

    std::size_t add_attribute(const VertexAttribute& attribute) {
        const auto view = begin_view(target_vertices);
        for (const double value : attribute.values) append(bytes_, static_cast<float>(value));
        const auto components = static_cast<std::size_t>(attribute.components);
        return keep(end_view(view, type_float, vector_types[components - 1], attribute.values.size() / components));
    }

    std::size_t add_colours(std::span<const std::array<std::uint8_t, 3>> colours) {
        const auto view = begin_view(target_vertices);
        // Four channels, since a vertex must begin at a multiple of 4 bytes.
        for (const auto& c : colours) {
            for (const auto channel : c) append(bytes_, linear(channel));
            append(bytes_, std::uint8_t{255});
        }
        Json accessor = end_view(view, type_uint8, "VEC4", colours.size());
        accessor["normalized"] = true;
        return keep(std::move(accessor));
    }

    std::size_t add_indices(std::span<const Triangle> triangles) {
        const auto view = begin_view(target_indices);
        for (const auto& t : triangles)
            for (const auto corner : t) append(bytes_, corner);
        return keep(end_view(view, type_uint32, "SCALAR", 3 * triangles.size()));
    }

    /// Plain numbers that belong to no vertex; the bounds are those of the rounded numbers.
    std::size_t add_scalars(std::span<const double> values, bool with_range) {
        const auto view = begin_view(std::nullopt);
        float smallest = std::numeric_limits<float>::max(), largest = -smallest;
        for (const double value : values) {
            const auto rounded = static_cast<float>(value);
            append(bytes_, rounded);
            smallest = std::min(smallest, rounded);
            largest = std::max(largest, rounded);
        }
        Json accessor = end_view(view, type_float, "SCALAR", values.size());
        if (with_range) {
            accessor["min"] = {smallest};
            accessor["max"] = {largest};
        }
        return keep(std::move(accessor));
    }

    std::size_t add_image(std::span<const std::uint8_t> png) {
        const auto view = begin_view(std::nullopt);
        bytes_.append(formats::as_text(png));
        views.back()["byteLength"] = png.size();
        return view;
    }

    [[nodiscard]] const std::string& bytes() const { return bytes_; }
    Json views = Json::array(), accessors = Json::array();

private:
    /// Vertex colours are linear light in glTF, ours are sRGB as pictures are.
    static std::uint8_t linear(std::uint8_t srgb) {
        const double c = srgb / 255.0;
        return static_cast<std::uint8_t>(
            std::lround(255.0 * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4))));
    }

    std::size_t begin_view(std::optional<int> target) {
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", 0}};
        if (target) view["target"] = *target;
        views.push_back(std::move(view));
        return views.size() - 1;
    }
    Json end_view(std::size_t view, int component_type, const char* type, std::size_t count) {
        views[view]["byteLength"] = bytes_.size() - views[view]["byteOffset"].get<std::size_t>();
        return {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}};
    }
    std::size_t keep(Json accessor) {
        accessors.push_back(std::move(accessor));
        return accessors.size() - 1;
    }

    std::string bytes_;
};

/// GLB has 32-bit floats: what is a number of 64 bits need not be one there.
template <class Vectorlike>
bool finite_as_float(const Vectorlike& v) {
    return v.template cast<float>().allFinite();
}

/// The name in glTF of a vertex attribute of Mimik's own: "displacement_mm" is _DISPLACEMENT_MM.
std::string semantic(const VertexAttribute& attribute) {
    std::string name = '_' + attribute.name;
    for (char& c : name)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return name;
}

void check(const GlbMesh& mesh) {
    const auto n = mesh.positions_mm.size();
    const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("GLB mesh '{}': {}", mesh.name, what));
    };
    const auto not_finite = [&](const std::string& what) {
        throw NumericalError(fmt::format("GLB mesh '{}': {} is not a finite 32-bit number", mesh.name, what));
    };
    if (mesh.triangles.empty()) refuse("there is no triangle");
    if (!mesh.normals.empty() && mesh.normals.size() != n)
        refuse(fmt::format("{} for {} vertices", base::counted(mesh.normals.size(), "normal"), n));
    if (!mesh.texture_coordinates.empty() && mesh.texture_coordinates.size() != n)
        refuse(
            fmt::format("{} for {} vertices", base::counted(mesh.texture_coordinates.size(), "texture position"), n));
    if (!mesh.colours.empty() && mesh.colours.size() != n)
        refuse(fmt::format("{} for {} vertices", base::counted(mesh.colours.size(), "colour"), n));
    for (const auto& t : mesh.triangles)
        for (const auto corner : t) {
            if (corner >= n) refuse(fmt::format("a triangle names vertex {} of {}", corner, n));
            if (!finite_as_float(mesh.positions_mm[corner]))
                not_finite(fmt::format("the position of vertex {}", corner));
            if (!mesh.texture_coordinates.empty() && !finite_as_float(mesh.texture_coordinates[corner]))
                not_finite(fmt::format("the texture position of vertex {}", corner));
        }
    if (!mesh.texture_png.empty()) {
        if (mesh.texture_coordinates.empty()) refuse("there is a texture but no texture positions");
        if (!std::equal(png_signature.begin(), png_signature.end(), mesh.texture_png.begin(),
                        mesh.texture_png.begin() +
                            static_cast<std::ptrdiff_t>(std::min(png_signature.size(), mesh.texture_png.size()))))
            refuse("the texture is not a PNG file");
    }
    for (const auto& target : mesh.morph_targets) {
        if (!std::isfinite(static_cast<float>(target.weight)))
            not_finite(fmt::format("morph target '{}': weight {}", target.name, target.weight));
        if (target.displacement_mm.size() != n)
            refuse(fmt::format("morph target '{}' has {} for {} vertices", target.name,
                               base::counted(target.displacement_mm.size(), "displacement"), n));
        for (const auto& t : mesh.triangles)
            for (const auto corner : t)
                if (!finite_as_float(target.displacement_mm[corner]))
                    not_finite(fmt::format("morph target '{}': the displacement of vertex {}", target.name, corner));
    }
    std::set<std::string> semantics;
    for (const auto& attribute : mesh.attributes) {
        const auto per_vertex = static_cast<std::size_t>(attribute.components);
        if (attribute.components < 1 || per_vertex > vector_types.size())
            refuse(fmt::format("attribute '{}' has {}; GLB holds 1 to {}", attribute.name,
                               base::counted(attribute.components, "component"), vector_types.size()));
        if (attribute.values.size() != n * per_vertex)
            refuse(fmt::format("attribute '{}' has {} for {} vertices of {}", attribute.name,
                               base::counted(attribute.values.size(), "value"), n,
                               base::counted(attribute.components, "component")));
        if (!semantics.insert(semantic(attribute)).second)
            refuse(fmt::format("two attributes would be called {}; leave one out", semantic(attribute)));
        for (const auto& t : mesh.triangles)
            for (const auto corner : t)
                for (std::size_t c = 0; c < per_vertex; ++c)
                    if (!std::isfinite(static_cast<float>(attribute.values[corner * per_vertex + c])))
                        not_finite(fmt::format("attribute '{}' of vertex {}", attribute.name, corner));
    }
}

/// @throws as encode_glb, of the animation alone.
void check_animation(const GlbMesh& mesh) {
    if (!mesh.animation) return;
    const auto& [name, times_s, weights] = *mesh.animation;
    const auto where = fmt::format("mesh '{}': animation '{}'", mesh.name, name);
    const auto targets = mesh.morph_targets.size();
    if (targets == 0) throw InputError(where + " moves no morph target; give some, or leave the animation out");
    if (targets > most_animated_targets)
        throw InputError(fmt::format("{} moves {} morph targets, and {} is the most; leave some out", where, targets,
                                     most_animated_targets));
    if (times_s.empty()) throw InputError(where + " has no frame; give at least one");
    if (weights.size() != times_s.size() * targets)
        throw InputError(fmt::format("{} has {} for {} of {}", where, base::counted(weights.size(), "weight"),
                                     base::counted(times_s.size(), "frame"), base::counted(targets, "target")));
    for (std::size_t k = 0; k < times_s.size(); ++k) {
        const auto time = static_cast<float>(times_s[k]);
        if (!std::isfinite(time) || time < 0)
            throw InputError(fmt::format("{}: time {} is {}; give seconds from 0 on", where, k, times_s[k]));
        if (k > 0 && time <= static_cast<float>(times_s[k - 1]))
            throw InputError(fmt::format("{}: time {} is {} s after {} s; give times that grow in 32 bits", where, k,
                                         times_s[k], times_s[k - 1]));
    }
    for (std::size_t k = 0; k < weights.size(); ++k)
        if (!std::isfinite(static_cast<float>(weights[k])))
            throw NumericalError(fmt::format("{}: weight {} of frame {} is {}, not finite in 32 bits", where,
                                             k % targets, k / targets, weights[k]));
}

/// One channel that sets the weights of the one node.
Json animation_json(const WeightAnimation& animation, Buffer& buffer) {
    const auto input = buffer.add_scalars(animation.times_s, true);
    const auto output = buffer.add_scalars(animation.weights, false);
    return {{"name", animation.name},
            {"samplers", Json::array({{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}})},
            {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}})}};
}

template <class T>
std::vector<T> gathered(const std::vector<T>& values, std::span<const std::uint32_t> vertices) {
    std::vector<T> out;
    if (values.empty()) return out;
    out.reserve(vertices.size());
    for (const auto v : vertices) out.push_back(values[v]);
    return out;
}

std::vector<VertexAttribute> gathered(const std::vector<VertexAttribute>& attributes,
                                      std::span<const std::uint32_t> vertices) {
    std::vector<VertexAttribute> out;
    for (const auto& attribute : attributes) {
        const auto per_vertex = static_cast<std::ptrdiff_t>(attribute.components);
        auto& values = out.emplace_back(VertexAttribute{attribute.name, attribute.components, {}}).values;
        for (const auto v : vertices) {
            const auto first = attribute.values.begin() + v * per_vertex;
            values.insert(values.end(), first, first + per_vertex);
        }
    }
    return out;
}

/// The mesh without vertices that no triangle uses.
GlbMesh compacted(const GlbMesh& mesh) {
    std::vector<std::uint32_t> new_index(mesh.positions_mm.size(), no_vertex), used;
    for (const auto& t : mesh.triangles)
        for (const auto corner : t) new_index[corner] = 0;
    for (std::uint32_t v = 0; v < new_index.size(); ++v)
        if (new_index[v] != no_vertex) {
            new_index[v] = static_cast<std::uint32_t>(used.size());
            used.push_back(v);
        }
    GlbMesh small;
    small.positions_mm = gathered(mesh.positions_mm, used);
    small.normals = gathered(mesh.normals, used);
    small.texture_coordinates = gathered(mesh.texture_coordinates, used);
    small.colours = gathered(mesh.colours, used);
    small.attributes = gathered(mesh.attributes, used);
    for (const auto& t : mesh.triangles) small.triangles.push_back({new_index[t[0]], new_index[t[1]], new_index[t[2]]});
    for (const auto& target : mesh.morph_targets)
        small.morph_targets.push_back(
            {target.name, gathered(target.displacement_mm, used), target.weight, target.arkit_name});
    return small;
}

/// Unit length is demanded of every normal, also where all triangles of a vertex have no area.
void make_unit(std::vector<Vector>& normals) {
    for (auto& n : normals) {
        const double length = n.norm();
        n = length > 1e-12 && std::isfinite(length) ? Vector(n / length) : Vector(Vector::UnitZ());
    }
}

/// Where the node stands: 32 bits keep less than 0.001 mm of positions up to here, so a mesh that lies further away is
/// written around a place of its own, in whole metres, which 32 bits hold exactly.
Vector node_offset_mm(const GlbMesh& mesh) {
    constexpr double near_mm = 1e4, metre_mm = 1e3;
    Vector low = Vector::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& t : mesh.triangles)
        for (const auto corner : t) {
            low = low.cwiseMin(mesh.positions_mm[corner]);
            high = high.cwiseMax(mesh.positions_mm[corner]);
        }
    if (std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()) <= near_mm) return Vector::Zero();
    return ((low + high) / (2 * metre_mm)).array().round() * metre_mm;
}

/// Whether viewers have to repeat the picture beyond its borders.
bool repeats_texture(const GlbMesh& mesh) {
    constexpr double slack = 1e-6;
    for (const auto& t : mesh.triangles)
        for (const auto corner : t) {
            const auto& uv = mesh.texture_coordinates[corner];
            if (uv.minCoeff() < -slack || uv.maxCoeff() > 1 + slack) return true;
        }
    return false;
}

Json mesh_json(const GlbMesh& source, const Vector& offset_mm, std::optional<std::size_t> material, Buffer& buffer) {
    auto mesh = compacted(source);
    for (auto& p : mesh.positions_mm) p -= offset_mm;
    if (mesh.normals.empty()) mesh.normals = geometry::vertex_normals(mesh.positions_mm, mesh.triangles);
    make_unit(mesh.normals);
    Json attributes;
    attributes["POSITION"] = buffer.add_floats(mesh.positions_mm, metres_per_mm, true);
    attributes["NORMAL"] = buffer.add_floats(mesh.normals, 1.0, false);
    if (!mesh.texture_coordinates.empty())
        attributes["TEXCOORD_0"] = buffer.add_texture_coordinates(mesh.texture_coordinates);
    // glTF multiplies colours into the texture, which would darken the picture twice.
    if (!mesh.colours.empty() && source.texture_png.empty()) attributes["COLOR_0"] = buffer.add_colours(mesh.colours);
    for (const auto& attribute : mesh.attributes) attributes[semantic(attribute)] = buffer.add_attribute(attribute);
    Json primitive = {{"attributes", attributes}, {"indices", buffer.add_indices(mesh.triangles)}, {"mode", 4}};
    if (material) primitive["material"] = *material;

    Json json = {{"name", source.name}};
    auto extras = object_of(source.extras);
    if (!mesh.morph_targets.empty()) {
        Json targets = Json::array(), names = Json::array(), arkit_names = Json::array(), weights = Json::array();
        bool arkit = false;
        for (const auto& target : mesh.morph_targets) {
            auto moved = mesh.positions_mm;
            for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += target.displacement_mm[i];
            auto normals = geometry::vertex_normals(moved, mesh.triangles);
            auto rest = geometry::vertex_normals(mesh.positions_mm, mesh.triangles);
            make_unit(normals);
            make_unit(rest);
            for (std::size_t i = 0; i < normals.size(); ++i) normals[i] -= rest[i];
            targets.push_back({{"POSITION", buffer.add_floats(target.displacement_mm, metres_per_mm, true)},
                               {"NORMAL", buffer.add_floats(normals, 1.0, false)}});
            names.push_back(target.name);
            arkit_names.push_back(target.arkit_name);
            arkit = arkit || !target.arkit_name.empty();
            weights.push_back(target.weight);
        }
        primitive["targets"] = targets;
        json["weights"] = weights;
        extras["targetNames"] = names;
        if (arkit) extras["arkitNames"] = arkit_names;
    }
    json["primitives"] = Json::array({primitive});
    if (!extras.empty()) json["extras"] = extras;
    return json;
}

/// Header and the two chunks of a GLB file.
std::vector<std::uint8_t> framed(std::string text, std::string binary) {
    binary.resize((binary.size() + 3) / 4 * 4);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
    const auto length = header_bytes + 2 * chunk_header_bytes + text.size() + binary.size();
    if (length > std::numeric_limits<std::uint32_t>::max())
        throw InputError(
            fmt::format("a GLB file holds at most 4 GB, and this mesh needs {} bytes; export fewer shapes", length));
    std::string out;
    out.reserve(length);
    out += "glTF";
    append(out, std::uint32_t{2});
    append(out, static_cast<std::uint32_t>(length));
    append(out, static_cast<std::uint32_t>(text.size()));
    out += "JSON";
    out += text;
    append(out, static_cast<std::uint32_t>(binary.size()));
    out += std::string_view("BIN\0", 4);
    out += binary;
    return {out.begin(), out.end()};
}

}  // namespace

std::vector<std::uint8_t> encode_glb(const GlbMesh& mesh) {
    check(mesh);
    check_animation(mesh);
    Buffer buffer;
    // Skin: no metal, rather dull. Scans are open surfaces, so both sides are drawn.
    Json surface = {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}};
    const bool textured = !mesh.texture_png.empty();
    const auto image = textured ? buffer.add_image(mesh.texture_png) : 0;
    if (textured)
        surface["baseColorTexture"] = {{"index", 0}};
    else if (mesh.colours.empty())
        surface["baseColorFactor"] = {0.8, 0.62, 0.53, 1.0};
    Json json = {{"asset", {{"version", "2.0"}, {"generator", "Mimik"}}}, {"scene", 0}};
    if (!mesh.asset_extras.empty()) json["asset"]["extras"] = object_of(mesh.asset_extras);
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    Json node = {{"name", mesh.name}, {"mesh", 0}};
    const auto offset_mm = node_offset_mm(mesh);
    if (!offset_mm.isZero(0.0)) {
        const Vector metres = offset_mm * metres_per_mm;
        node["translation"] = {metres.x(), metres.y(), metres.z()};
    }
    json["nodes"] = Json::array({node});
    json["meshes"] = Json::array({mesh_json(mesh, offset_mm, 0, buffer)});
    json["materials"] = Json::array({{{"name", mesh.name}, {"pbrMetallicRoughness", surface}, {"doubleSided", true}}});
    if (textured) {
        json["textures"] = Json::array({{{"sampler", 0}, {"source", 0}}});
        json["images"] = Json::array({{{"mimeType", "image/png"}, {"bufferView", image}}});
        constexpr int clamp = 33071, repeat = 10497;
        const int wrap = repeats_texture(mesh) ? repeat : clamp;
        json["samplers"] = Json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", wrap}, {"wrapT", wrap}}});
    }
    if (mesh.animation) json["animations"] = Json::array({animation_json(*mesh.animation, buffer)});
    auto binary = buffer.bytes();
    json["accessors"] = std::move(buffer.accessors);
    json["bufferViews"] = std::move(buffer.views);
    json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    return framed(json.dump(-1, ' ', false, Json::error_handler_t::replace), std::move(binary));
}

void write_glb(const std::filesystem::path& file, const GlbMesh& mesh) {
    std::vector<std::uint8_t> bytes;
    try {
        bytes = encode_glb(mesh);
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}: not written: {}", file.string(), e.what()));
    } catch (const NumericalError& e) {
        throw NumericalError(fmt::format("{}: not written: {}", file.string(), e.what()));
    }
    base::write_atomically(file, formats::as_text(bytes));
}

std::vector<std::string> animation_remarks(const GlbMesh& mesh) {
    if (!mesh.animation || mesh.morph_targets.empty()) return {};
    constexpr double active = 1e-3;  // of a displacement; what is less is not seen
    const auto targets = static_cast<std::ptrdiff_t>(mesh.morph_targets.size());
    const auto& weights = mesh.animation->weights;
    std::ptrdiff_t most = 0, most_frame = 0, frames = 0;
    for (std::ptrdiff_t at = 0; at + targets <= std::ssize(weights); at += targets) {
        const auto count = std::count_if(weights.begin() + at, weights.begin() + at + targets,
                                         [](double w) { return std::abs(w) > active; });
        frames += count > static_cast<std::ptrdiff_t>(most_active_targets) ? 1 : 0;
        if (count > most) {
            most = count;
            most_frame = at / targets;
        }
    }
    if (frames == 0) return {};
    return {
        fmt::format("more than {} morph targets are active at once in {}, {} in frame {}; viewers need not show "
                    "more than {}",
                    most_active_targets, base::counted(static_cast<std::uint64_t>(frames), "frame"), most, most_frame,
                    most_active_targets)};
}

GlbMesh glb_mesh(const Mesh& mesh, std::vector<std::uint32_t>* source_vertex) {
    GlbMesh out;
    std::vector<std::uint32_t> sources;
    if (mesh.faces.texture_corners.empty()) {
        out.positions_mm = mesh.vertices_mm;
        out.texture_coordinates = mesh.texture_coordinates;
        out.triangles = geometry::triangulate(mesh.faces, mesh.vertices_mm);
        for (std::uint32_t v = 0; v < mesh.vertices_mm.size(); ++v) sources.push_back(v);
    } else {
        Faces split;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> index;
        std::vector<std::uint32_t> face;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            face.clear();
            for (auto k = mesh.faces.first[f]; k < mesh.faces.first[f + 1]; ++k) {
                const std::pair key(mesh.faces.corners[k], mesh.faces.texture_corners[k]);
                const auto [it, added] = index.try_emplace(key, static_cast<std::uint32_t>(sources.size()));
                if (added) {
                    sources.push_back(key.first);
                    out.positions_mm.push_back(mesh.vertices_mm[key.first]);
                    out.texture_coordinates.push_back(mesh.texture_coordinates[key.second]);
                }
                face.push_back(it->second);
            }
            split.add(face);
        }
        out.triangles = geometry::triangulate(split, out.positions_mm);
    }
    // Normals of the surface as it was before the seams were cut.
    out.normals = gathered(
        geometry::vertex_normals(mesh.vertices_mm, geometry::triangulate(mesh.faces, mesh.vertices_mm)), sources);
    out.colours = gathered(mesh.colours, sources);
    out.attributes = gathered(mesh.attributes, sources);
    if (source_vertex) *source_vertex = std::move(sources);
    return out;
}

}  // namespace mimik::io
