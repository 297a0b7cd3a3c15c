#include "animation/face_export.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "geometry/file.h"
#include "geometry/glb.h"
#include "geometry/mesh_io.h"

namespace mimik::animation {

using geometry::Mesh;
using geometry::Vector;

namespace {

/// The grid with the given displacement of its neutral vertices, in the frame asked for.
Mesh mesh_of(const geometry::QuadGrid& neutral, const std::vector<Vector>& displacement_mm, const TargetFace& target,
             const ExportOptions& options, std::vector<std::uint32_t>* kept_vertices = nullptr) {
    const bool average = options.frame == OutputFrame::average;
    std::vector<std::uint32_t> kept;
    Mesh mesh = geometry::to_mesh(neutral, options.bridged, &kept);
    geometry::VertexAttribute displacement{"displacement_mm", 3, {}};
    for (std::size_t k = 0; k < kept.size(); ++k) {
        Vector d = displacement_mm[kept[k]];
        auto& position_mm = mesh.vertices_mm[k];
        position_mm += d;
        if (average) {
            position_mm = target.average_from_scan() * position_mm;
            d = target.average_from_scan().linear() * d;
        }
        displacement.values.insert(displacement.values.end(), d.begin(), d.end());
    }
    mesh.attributes.insert(mesh.attributes.begin(), std::move(displacement));
    if (kept_vertices) *kept_vertices = std::move(kept);
    return mesh;
}

std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}  // namespace

Mesh to_mesh(const AnimatedFace& animated, const TargetFace& target, const ExportOptions& options) {
    return mesh_of(target.face().grid, animated.displacement_mm, target, options);
}

void write_animated_face(const std::filesystem::path& file, const AnimatedFace& animated, const TargetFace& target,
                         std::span<const NamedMagnitude> names, const std::filesystem::path& texture_file,
                         const ExportOptions& options) {
    const auto extension = lower_extension(file);
    if (extension == ".glb") {
        if (names.size() != animated.fields_mm.size())
            throw InputError(fmt::format("{}: {} names for {} expressions; give each morph target its name",
                                         file.string(), names.size(), animated.fields_mm.size()));
        const auto& grid = target.face().grid;
        const std::vector<Vector> still(grid.size(), Vector::Zero());
        std::vector<std::uint32_t> kept;
        const auto neutral = mesh_of(grid, still, target, options, &kept);
        std::vector<std::uint32_t> source;
        auto mesh = geometry::glb_mesh(neutral, &source);
        mesh.name = target.face().id.subject;
        if (!texture_file.empty()) mesh.texture_png = geometry::read_bytes(texture_file);
        const Eigen::Matrix3d turn = options.frame == OutputFrame::average
                                         ? Eigen::Matrix3d(target.average_from_scan().linear())
                                         : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
        for (std::size_t k = 0; k < animated.fields_mm.size(); ++k) {
            geometry::MorphTarget morph{names[k].name, {}, names[k].magnitude};
            for (const auto v : source) morph.displacement_mm.push_back(turn * animated.fields_mm[k][kept[v]]);
            mesh.morph_targets.push_back(std::move(morph));
        }
        geometry::GlbScene scene;
        scene.meshes.push_back(std::move(mesh));
        geometry::write_glb(file, scene);
        return;
    }
    if (extension != ".ply" && extension != ".obj" && extension != ".vtp")
        throw InputError(fmt::format("{}: an animated face is written as .ply, .obj, .vtp or .glb, not '{}'",
                                     file.string(), extension));
    geometry::MeshWriteOptions write_options;
    if (!texture_file.empty()) {
        const auto bytes = geometry::read_bytes(texture_file);
        auto copy = file;
        copy.replace_extension(".png");
        geometry::write_atomically(copy, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
        write_options.texture_file = copy.filename().string();
    }
    geometry::write_mesh(file, to_mesh(animated, target, options), write_options);
}

}  // namespace mimik::animation
