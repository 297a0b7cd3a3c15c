#include "io/warp_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/text.h"
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

bool is_csv(const std::filesystem::path& file) { return base::equal_ignoring_case(file.extension().string(), ".csv"); }

double root_mean_square_radius(std::span<const Point> points) {
    Point centre = Point::Zero();
    for (const auto& p : points) centre += p / static_cast<double>(points.size());
    double sum = 0;
    for (const auto& p : points) sum += (p - centre).squaredNorm();
    return std::sqrt(sum / static_cast<double>(points.size()));
}

void require_partners(const LandmarkPairing& pairing) {
    const auto lacking = [](const std::vector<std::string>& names, const char* where, const char* other) {
        return names.empty() ? std::string()
                             : fmt::format("only the {} landmarks have '{}', the {} ones lack {}", where,
                                           fmt::join(names, "', '"), other, names.size() == 1 ? "it" : "them");
    };
    const auto first = lacking(pairing.only_in_source, "source", "target");
    const auto second = lacking(pairing.only_in_target, "target", "source");
    if (first.empty() && second.empty()) return;
    throw InputError(fmt::format("landmarks without a partner: {}{}{}; mark them in both or delete them", first,
                                 first.empty() || second.empty() ? "" : "; ", second));
}

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
                         const std::filesystem::path& output, const WarpOptions& warp_options) {
    if (texture.empty() || !base::is_there(folder / texture)) return {};
    if (warp_options.check_texture) warp_options.check_texture(folder / texture);
    const auto image = base::read_text(folder / texture);
    const auto extension = std::filesystem::path(texture).extension().string();
    const auto copy = output.parent_path() / (output.stem().string() + "_texture" + extension);
    base::write_atomically(copy, image);
    return copy.filename().string();
}

void write_output(const std::filesystem::path& output, WarpInput warp, const std::filesystem::path& input,
                  const WarpOptions& warp_options) {
    auto& mesh = warp.file.mesh;
    if (!is_csv(output)) {
        MeshWriteOptions options;
        if (takes_texture(output))
            options.texture_file = copy_texture(warp.file.texture_file, input.parent_path(), output, warp_options);
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

void WarpOptions::check() const {
    ThinPlateSplineOptions{.kernel = kernel, .smoothing = smoothing}.check();
    for (const auto& [field, value] : {std::pair{"min_separation_ratio", min_separation_ratio},
                                       std::pair{"min_thickness_ratio", min_thickness_ratio}})
        if (!(value >= 0 && value < 1))
            throw InputError(fmt::format("{} is {}; give 0 or more, and less than 1", field, value));
}

ThinPlateSpline fit_landmark_spline(const Landmarks& from, const Landmarks& to, const WarpOptions& options) {
    options.check();
    const auto pairing = geometry::pair_by_name(from, to);
    require_partners(pairing);
    std::vector<Point> source, target;
    std::vector<std::string> names;
    for (const auto& pair : pairing.pairs) {
        source.push_back(pair.source_mm);
        target.push_back(pair.target_mm);
        names.push_back(pair.name);
    }
    const double size = source.empty() ? 0.0 : root_mean_square_radius(source);
    return ThinPlateSpline::fit(source, target,
                                {.kernel = options.kernel,
                                 .smoothing = options.smoothing,
                                 .min_separation_mm = options.min_separation_ratio * size,
                                 .min_thickness_mm = options.min_thickness_ratio * size},
                                names);
}

Mesh warped(Mesh mesh, const ThinPlateSpline& spline) {
    spline.apply(mesh.vertices_mm, mesh.vertices_mm);
    return mesh;
}

WarpReport warp_file(const std::filesystem::path& from, const std::filesystem::path& to,
                     const std::filesystem::path& input, const std::filesystem::path& output,
                     const WarpOptions& options) {
    check_output_format(output);
    auto warp = read_input(input, output);
    const auto& points = warp.file.mesh.vertices_mm;
    const auto source = read_landmarks(from), target = read_landmarks(to);
    const auto spline = fit_landmark_spline(source, target, options);

    WarpReport report;
    report.landmarks = source.size();
    report.points = points.size();
    report.bending_energy = spline.bending_energy();
    for (const auto& mark : source.all())
        report.largest_landmark_residual = std::max(report.largest_landmark_residual,
                                                    (spline(mark.position_mm) - target.position_mm(mark.name)).norm());
    const auto before = points;
    warp.file.mesh = warped(std::move(warp.file.mesh), spline);
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
    write_output(output, std::move(warp), input, options);
    return report;
}

}  // namespace mimik::io
