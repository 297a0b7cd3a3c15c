#include "io/warp_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
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

bool is_csv(const std::filesystem::path& file) {
    const auto extension = base::lower_case(file.extension().string());
    return extension == ".csv" || extension == ".tsv";
}

/// What the input file holds: a mesh (for CSV a bare cloud), and names if it had them.
struct WarpInput {
    MeshFile file;
    std::vector<std::string> names;
};

WarpInput read_input(const std::filesystem::path& input) {
    if (!is_csv(input)) {
        WarpInput mesh = {read_mesh_file(input, LengthUnit::millimetre, MeshParts::all, BadTexture::report), {}};
        if (mesh_format(input) == MeshFormat::pcd) drop_unmeasured(mesh.file, input.string());
        return mesh;
    }
    auto table = read_points_csv(input);
    WarpInput result;
    result.file.mesh.vertices_mm = std::move(table.points);
    result.file.frame = table.frame;
    result.names = std::move(table.names);
    return result;
}

}  // namespace

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

bool takes_texture(const std::filesystem::path& output) {
    return !is_csv(output) && (mesh_format(output) == MeshFormat::ply || mesh_format(output) == MeshFormat::obj);
}

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

namespace {

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
        options.frame = warp.file.frame;
        auto written = write_mesh(output, mesh, options);
        std::move(written.begin(), written.end(), std::back_inserter(remarks));
        return;
    }
    if (warp.names.empty()) {
        warp.names.reserve(mesh.vertices_mm.size());
        for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) warp.names.push_back(std::to_string(i));
    }
    write_points_csv(output, {std::move(warp.names), std::move(mesh.vertices_mm), warp.file.frame});
}

/// Found out before the work, not after it.
void check_output_format(const std::filesystem::path& output) {
    const auto extension = base::lower_case(output.extension().string());
    for (const char* written : {".csv", ".ply", ".obj", ".stl", ".vtp"})
        if (extension == written) return;
    throw InputError(fmt::format("{}: files of extension {} are not written; give .csv, .ply, .obj, .stl or .vtp",
                                 output.string(), base::in_quotes(extension)));
}

std::vector<Point> positions(const Landmarks& landmarks) {
    std::vector<Point> points;
    for (const auto& mark : landmarks.all()) points.push_back(mark.position_mm);
    return points;
}

std::vector<Point> positions_in_lps(const LandmarkFile& marks) {
    auto points = positions(marks.landmarks);
    if (marks.frame == BodyFrame::ras) negate_x_and_y(points);
    return points;
}

/// The marks of both files, brought into the frame of the input.
class WarpMarks {
public:
    WarpMarks(const std::filesystem::path& from, const std::filesystem::path& to)
        : from_name_(from.string()),
          to_name_(to.string()),
          from_(read_landmark_file(from)),
          to_(read_landmark_file(to)) {}

    void bring_into_frame_of(const MeshFile& input, const std::string& name, const WarpFileOptions& more,
                             std::vector<std::string>& remarks) {
        for (const auto* marks : {&from_, &to_})
            remarks.insert(remarks.end(), marks->remarks.begin(), marks->remarks.end());
        if (more.input_frame && input.frame && more.input_frame != input.frame)
            throw InputError(fmt::format("{}: says that it is in {}, not {}; leave the frame out", name,
                                         to_string(*input.frame), to_string(*more.input_frame)));
        if (!from_.frame && !to_.frame) return;
        auto frame = input.frame ? input.frame : more.input_frame;
        std::string why = fmt::format("{} is in it", name);
        if (!frame) {
            frame = judged(input.mesh.vertices_mm);
            why = fmt::format("{} states no frame, and they lie on it so", name);
        }
        if (!frame) {
            frame = BodyFrame::lps;
            why = fmt::format("{} states no frame and is taken to be in LPS, as Slicer does", name);
        }
        bring(from_, from_name_, *frame, why, remarks);
        bring(to_, to_name_, *frame, why, remarks);
    }

    void pair_by_order(std::vector<std::string>& remarks) {
        const auto& from = from_.landmarks;
        const auto& to = to_.landmarks;
        if (from.size() != to.size() || from.empty())
            throw InputError(
                fmt::format("{} has {} landmarks and {} has {}; to be paired by their order they need as "
                            "many",
                            from_name_, from.size(), to_name_, to.size()));
        remarks.push_back(fmt::format("landmarks are paired by their order, {} of {} with {} of {} and so on",
                                      base::in_quotes(from.all()[0].name), from_name_,
                                      base::in_quotes(to.all()[0].name), to_name_));
        std::vector<geometry::Landmark> renamed(to.all().begin(), to.all().end());
        for (std::size_t k = 0; k < renamed.size(); ++k) renamed[k].name = from.all()[k].name;
        to_.landmarks = Landmarks(std::move(renamed));
    }

    [[nodiscard]] ThinPlateSpline fit(const ThinPlateSplineOptions& options) const {
        try {
            const geometry::LandmarkPairs pairs(from_.landmarks, to_.landmarks);
            try {
                pairs.require_partners();
            } catch (const InputError& e) {
                const bool as_many = from_.landmarks.size() == to_.landmarks.size();
                throw InputError(
                    fmt::format("{}{}", e.what(), as_many ? ", or pair them by their order (--pair-by order)" : ""));
            }
            return pairs.fit(options);
        } catch (const InputError& e) {
            throw InputError(fmt::format("{}, {}: {}", from_name_, to_name_, e.what()));
        } catch (const NumericalError& e) {
            throw NumericalError(fmt::format("{}, {}: {}", from_name_, to_name_, e.what()));
        }
    }

    [[nodiscard]] const Landmarks& from() const { return from_.landmarks; }
    [[nodiscard]] const Landmarks& to() const { return to_.landmarks; }

private:
    [[nodiscard]] std::optional<BodyFrame> judged(const std::vector<Point>& mesh_points) const {
        return from_.frame ? frame_judged_by(positions_in_lps(from_), mesh_points) : judged_by_partners();
    }
    /// Marks without a frame are in the input's numbers: the frame in which their partners lie less than half as far
    /// off.
    [[nodiscard]] std::optional<BodyFrame> judged_by_partners() const {
        const auto to_lps = positions_in_lps(to_);
        double lps = 0, ras = 0;
        for (std::size_t k = 0; k < to_lps.size(); ++k) {
            const auto* partner = from_.landmarks.find(to_.landmarks.all()[k].name);
            if (!partner) continue;
            lps += (to_lps[k] - partner->position_mm).norm();
            ras += (Point(-to_lps[k].x(), -to_lps[k].y(), to_lps[k].z()) - partner->position_mm).norm();
        }
        if (lps < 0.5 * ras) return BodyFrame::lps;
        if (ras < 0.5 * lps) return BodyFrame::ras;
        return std::nullopt;
    }
    static void bring(LandmarkFile& marks, const std::string& name, BodyFrame frame, const std::string& why,
                      std::vector<std::string>& remarks) {
        if (!marks.frame || *marks.frame == frame) return;
        std::vector<geometry::Landmark> negated(marks.landmarks.all().begin(), marks.landmarks.all().end());
        for (auto& mark : negated) negate_x_and_y({&mark.position_mm, 1});
        marks.landmarks = Landmarks(std::move(negated));
        remarks.push_back(fmt::format("{}: says that it is in {}; x and y are negated, to {}: {}", name,
                                      to_string(*marks.frame), to_string(frame), why));
        marks.frame = frame;
    }

    std::string from_name_, to_name_;
    LandmarkFile from_, to_;
};

/// @throws NumericalError naming the first point whose place is no number.
double largest_displacement(const std::vector<Point>& before, const WarpInput& warp, const std::string& input) {
    double largest = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double moved = (warp.file.mesh.vertices_mm[i] - before[i]).norm();
        if (!std::isfinite(moved))
            throw NumericalError(
                fmt::format("{}: point {} at ({}, {}, {}) is so far from the landmarks that its place has no number; "
                            "give it in the unit and frame of the landmarks",
                            input, warp.names.empty() ? std::to_string(i) : base::in_quotes(warp.names[i]),
                            before[i].x(), before[i].y(), before[i].z()));
        largest = std::max(largest, moved);
    }
    return largest;
}

}  // namespace

WarpReport warp_file(const std::filesystem::path& from, const std::filesystem::path& to,
                     const std::filesystem::path& input, const std::filesystem::path& output,
                     const geometry::ThinPlateSplineOptions& options, const CheckTexture& check_texture,
                     const WarpFileOptions& more) {
    check_output_format(output);
    auto warp = read_input(input);
    WarpReport report;
    report.remarks = std::move(warp.file.remarks);
    WarpMarks marks(from, to);
    if (more.pair_by == PairBy::order) marks.pair_by_order(report.remarks);
    marks.bring_into_frame_of(warp.file, input.string(), more, report.remarks);
    const auto spline = marks.fit(options);

    report.landmarks = marks.from().size();
    report.points = warp.file.mesh.vertices_mm.size();
    report.bending_energy = spline.bending_energy();
    for (const auto& mark : marks.from().all())
        report.largest_landmark_residual = std::max(
            report.largest_landmark_residual, (spline(mark.position_mm) - marks.to().position_mm(mark.name)).norm());
    const auto before = warp.file.mesh.vertices_mm;
    spline.apply(warp.file.mesh.vertices_mm, warp.file.mesh.vertices_mm);
    report.largest_displacement = largest_displacement(before, warp, input.string());
    MeshWriteOptions write_options;
    write_options.made_by = more.made_by;
    write_output(output, std::move(warp), input, check_texture, std::move(write_options), report.remarks);
    return report;
}

}  // namespace mimik::io
