#include "io/warp_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
#include "geometry/landmark_spline.h"
#include "io/image.h"
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "io/points_csv.h"
#include "io/texture_path.h"

namespace mimik::io {

using geometry::LandmarkPairing;
using geometry::Landmarks;
using geometry::Mesh;
using geometry::Point;
using geometry::ThinPlateSpline;
using geometry::ThinPlateSplineOptions;

namespace {

using CheckTexture = std::function<void(const std::filesystem::path&)>;

bool is_csv(const std::filesystem::path& file) { return base::equal_ignoring_case(file.extension().string(), ".csv"); }

/// What the input file holds: a mesh (for CSV a bare cloud), and names if it had them.
struct WarpInput {
    MeshFile file;
    std::vector<std::string> names;
};

bool takes_texture(const std::filesystem::path& output) {
    return !is_csv(output) && (mesh_format(output) == MeshFormat::ply || mesh_format(output) == MeshFormat::obj);
}

WarpInput read_input(const std::filesystem::path& input) {
    if (!is_csv(input)) return {read_mesh_file(input, LengthUnit::millimetre, MeshParts::all, BadTexture::report), {}};
    auto table = read_points_csv(input);
    WarpInput result;
    result.file.mesh.vertices_mm = std::move(table.points);
    result.names = std::move(table.names);
    return result;
}

/// An image that may be handed on: it lies with the mesh, also where links lead, and is one by its content.
std::string checked_image(const std::filesystem::path& image, const std::filesystem::path& folder,
                          const std::string& mesh) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(
            fmt::format("{}: texture {} is left out: {}", mesh, base::in_quotes(image.filename().string()), why));
    };
    if (!base::is_there(image)) refuse("it is not beside the mesh; copy it there");
    if (!lies_below(image, folder)) refuse("it is a link that leads out of the mesh's folder; copy the image there");
    auto content = base::read_text(image);
    try {
        check_is_image({reinterpret_cast<const std::uint8_t*>(content.data()), content.size()}, image.string());
    } catch (const InputError& e) {
        throw InputError(fmt::format("{}; the texture is left out", e.what()));
    }
    return content;
}

/// The images become ones that belong to the output, so that no other of their names is taken for them.
void copy_textures(MeshFile& file, const std::filesystem::path& input, const std::filesystem::path& output,
                   const CheckTexture& check_texture, MeshWriteOptions& options, std::vector<std::string>& remarks) {
    const auto folder = input.parent_path();
    std::vector<std::uint32_t> new_number;
    for (const auto& texture : file.texture_files) {
        new_number.push_back(no_picture);
        const auto image = folder / texture;
        if (check_texture && base::is_there(image)) check_texture(image);
        std::string content;
        try {
            content = checked_image(image, folder, input.string());
        } catch (const InputError& e) {
            remarks.emplace_back(e.what());
            continue;
        }
        const auto number = options.texture_files.size();
        auto name = output.stem().string() + "_texture";
        if (number > 0) name += fmt::format("_{}", number + 1);
        name += std::filesystem::path(texture).extension().string();
        base::write_atomically(output.parent_path() / name, content);
        options.texture_files.push_back(std::move(name));
        new_number.back() = static_cast<std::uint32_t>(number);
    }
    if (options.texture_files.size() < file.texture_files.size() && file.face_textures.empty())
        file.face_textures.assign(file.mesh.faces.size(), 0);
    options.face_textures = file.face_textures;
    for (auto& picture : options.face_textures)
        if (picture != no_picture) picture = new_number[picture];
}

void write_output(const std::filesystem::path& output, WarpInput warp, const std::filesystem::path& input,
                  const CheckTexture& check_texture, MeshWriteOptions options, std::vector<std::string>& remarks) {
    auto& mesh = warp.file.mesh;
    if (!is_csv(output)) {
        if (takes_texture(output)) {
            if (!warp.file.texture_error.empty()) remarks.push_back(warp.file.texture_error);
            copy_textures(warp.file, input, output, check_texture, options, remarks);
        } else if (!warp.file.texture_files.empty()) {
            remarks.push_back(
                fmt::format("{}: the format names no image, so the texture is left out; .ply and .obj "
                            "keep it",
                            output.string()));
        }
        write_mesh(output, mesh, options);
        return;
    }
    if (warp.names.empty()) {
        warp.names.reserve(mesh.vertices_mm.size());
        for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) warp.names.push_back(std::to_string(i));
    }
    write_points_csv(output, {std::move(warp.names), std::move(mesh.vertices_mm)});
}

/// Found out before the work, not after it.
void check_output_format(const std::filesystem::path& output) {
    const auto extension = base::lower_case(output.extension().string());
    for (const char* written : {".csv", ".ply", ".obj", ".stl", ".vtp"})
        if (extension == written) return;
    throw InputError(fmt::format("{}: files of extension {} are not written; give .csv, .ply, .obj, .stl or .vtp",
                                 output.string(), base::in_quotes(extension)));
}

}  // namespace

WarpReport warp_file(const std::filesystem::path& from, const std::filesystem::path& to,
                     const std::filesystem::path& input, const std::filesystem::path& output,
                     const geometry::ThinPlateSplineOptions& options, const CheckTexture& check_texture,
                     const MadeBy& made_by) {
    check_output_format(output);
    auto warp = read_input(input);
    const auto& points = warp.file.mesh.vertices_mm;
    const auto source = read_landmarks(from), target = read_landmarks(to);
    const geometry::LandmarkPairs pairs(source, target);
    pairs.require_partners();
    const auto spline = pairs.fit(options);

    WarpReport report;
    report.landmarks = source.size();
    report.points = points.size();
    report.bending_energy = spline.bending_energy();
    for (const auto& mark : source.all())
        report.largest_landmark_residual = std::max(report.largest_landmark_residual,
                                                    (spline(mark.position_mm) - target.position_mm(mark.name)).norm());
    const auto before = points;
    spline.apply(warp.file.mesh.vertices_mm, warp.file.mesh.vertices_mm);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double moved = (warp.file.mesh.vertices_mm[i] - before[i]).norm();
        if (!std::isfinite(moved))
            throw NumericalError(
                fmt::format("{}: point {} at ({}, {}, {}) is so far from the landmarks that its place has no number; "
                            "give it in the unit and frame of the landmarks",
                            input.string(), warp.names.empty() ? std::to_string(i) : base::in_quotes(warp.names[i]),
                            before[i].x(), before[i].y(), before[i].z()));
        report.largest_displacement = std::max(report.largest_displacement, moved);
    }
    report.remarks = std::move(warp.file.remarks);
    MeshWriteOptions write_options;
    write_options.made_by = made_by;
    write_output(output, std::move(warp), input, check_texture, std::move(write_options), report.remarks);
    return report;
}

}  // namespace mimik::io
