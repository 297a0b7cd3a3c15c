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
#include "io/landmark_io.h"
#include "io/mesh_io.h"
#include "io/points_csv.h"

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

WarpInput read_input(const std::filesystem::path& input, const std::filesystem::path& output) {
    if (!is_csv(input))
        return {read_mesh_file(input, LengthUnit::millimetre, MeshParts::all,
                               takes_texture(output) ? BadTexture::refuse : BadTexture::report),
                {}};
    auto table = read_points_csv(input);
    WarpInput result;
    result.file.mesh.vertices_mm = std::move(table.points);
    result.names = std::move(table.names);
    return result;
}

/// The image as one that belongs to the output, so that no other of its name is taken for it. @return its name; empty
/// if there is no image.
std::string copy_texture(const std::string& texture, const std::filesystem::path& folder,
                         const std::filesystem::path& output, const CheckTexture& check_texture) {
    if (texture.empty() || !base::is_there(folder / texture)) return {};
    if (check_texture) check_texture(folder / texture);
    const auto image = base::read_text(folder / texture);
    const auto extension = std::filesystem::path(texture).extension().string();
    const auto copy = output.parent_path() / (output.stem().string() + "_texture" + extension);
    base::write_atomically(copy, image);
    return copy.filename().string();
}

void write_output(const std::filesystem::path& output, WarpInput warp, const std::filesystem::path& input,
                  const CheckTexture& check_texture) {
    auto& mesh = warp.file.mesh;
    if (!is_csv(output)) {
        MeshWriteOptions options;
        if (takes_texture(output))
            options.texture_file = copy_texture(warp.file.texture_file, input.parent_path(), output, check_texture);
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
                     const geometry::ThinPlateSplineOptions& options, const CheckTexture& check_texture) {
    check_output_format(output);
    auto warp = read_input(input, output);
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
    write_output(output, std::move(warp), input, check_texture);
    return report;
}

}  // namespace mimik::io
