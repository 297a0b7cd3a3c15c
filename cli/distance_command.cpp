#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/output_folder.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/error_report.h"
#include "cli/terminal.h"
#include "database/hidden_subjects.h"
#include "evaluation/surface_distance.h"
#include "geometry/vertex_attributes.h"
#include "io/json_values.h"
#include "io/mesh_io.h"
#include "io/points_csv.h"

namespace mimik::cli {
namespace {

using evaluation::DistanceSummary;
using evaluation::VertexDistances;

struct Request {
    Common common;
    std::filesystem::path test, reference, output;
};

io::MeshFile read_surface(const std::filesystem::path& file) {
    auto content = io::read_mesh_file(file, io::LengthUnit::millimetre, io::MeshParts::all, io::BadTexture::report);
    if (io::mesh_format(file) == io::MeshFormat::pcd) io::drop_unmeasured(content, file.string());
    return content;
}

io::MeshFile read_test(const std::filesystem::path& file) {
    const auto extension = base::lower_case(file.extension().string());
    if (extension != ".csv" && extension != ".tsv") return read_surface(file);
    auto table = io::read_points_csv(file);
    io::MeshFile cloud;
    cloud.mesh.vertices_mm = std::move(table.points);
    cloud.frame = table.frame;
    return cloud;
}

/// Brings the reference into the frame of the test, so that what is written keeps the test's own. Where only one states
/// a frame (LPS or RAS), the other's is the one in which the first lies on it, else LPS, as Slicer takes a mesh.
void bring_into_one_frame(io::MeshFile& reference, const io::MeshFile& test, const Request& request,
                          std::vector<std::string>& remarks) {
    if (!reference.frame && !test.frame) return;
    const auto frame_of = [](const io::MeshFile& file, const io::MeshFile& other) {
        if (file.frame) return *file.frame;
        auto points = other.mesh.vertices_mm;
        if (other.frame == io::BodyFrame::ras) io::negate_x_and_y(points);
        return io::frame_judged_by(points, file.mesh.vertices_mm).value_or(io::BodyFrame::lps);
    };
    const auto test_frame = frame_of(test, reference), reference_frame = frame_of(reference, test);
    if (test_frame == reference_frame) return;
    io::negate_x_and_y(reference.mesh.vertices_mm);
    const auto described = [](const std::filesystem::path& file, const io::MeshFile& mesh, io::BodyFrame frame) {
        return fmt::format("{} {} {}", file.string(), mesh.frame ? "says that it is in" : "is taken to be in",
                           io::to_string(frame));
    };
    remarks.push_back(fmt::format("{}, {}; x and y of the reference are negated",
                                  described(request.test, test, test_frame),
                                  described(request.reference, reference, reference_frame)));
}

nlohmann::ordered_json json_of(const DistanceSummary& s) {
    return {
        {"n", s.n},        {"mean", s.mean_mm},           {"rms", s.rms_mm}, {"median", s.median_mm}, {"p95", s.p95_mm},
        {"max", s.max_mm}, {"border_hits", s.border_hits}};
}

std::string line_of(const char* side, const DistanceSummary& s) {
    return fmt::format("{:<18} {:>8} {:>10.4f} {:>10.4f} {:>10.4f} {:>10.4f} {:>10.4f} {:>8}\n", side, s.n, s.mean_mm,
                       s.rms_mm, s.median_mm, s.p95_mm, s.max_mm, s.border_hits);
}

void write_distances(const Request& request, geometry::Mesh mesh, std::optional<io::BodyFrame> frame,
                     const VertexDistances& distances, std::vector<std::string>& remarks) {
    geometry::set_attribute(mesh, {"distance_mm", 1, distances.distance_mm});
    geometry::set_attribute(mesh, {"on_border", 1, {distances.on_border.begin(), distances.on_border.end()}});
    io::MeshWriteOptions options;
    options.frame = frame;
    const std::array files = {request.test, request.reference};
    options.made_by = database::said_in_files(database::origin_to_carry(files));
    auto written = io::write_mesh(base::where_links_lead(request.output), mesh, options);
    remarks.insert(remarks.end(), written.begin(), written.end());
}

/// Vertices that no polygon has: cells of a workspace's grid outside the face, or points beside a mesh.
std::ptrdiff_t vertices_without_face(const geometry::Mesh& mesh) {
    std::vector<bool> has_face(mesh.vertices_mm.size(), false);
    for (const auto corner : mesh.faces.corners) has_face[corner] = true;
    return std::count(has_face.begin(), has_face.end(), false);
}

/// Found out before the work: the other formats would drop the distances in silence.
void check_output(const std::filesystem::path& file) {
    const auto extension = base::lower_case(file.extension().string());
    if (!file.empty() && extension != ".vtp" && extension != ".ply")
        throw InputError(
            fmt::format("{}: extension '{}' holds no value per vertex; give .vtp or .ply", file.string(), extension));
}

void run(const Request& request) {
    check_output(request.output);
    for (const auto& file : {request.test, request.reference}) {
        refuse_range_scan(file);
        database::refuse_hidden_file(file);
    }
    auto test_file = naming(request.test, [&] { return read_test(request.test); });
    auto reference_file = naming(request.reference, [&] { return read_surface(request.reference); });
    std::vector<std::string> remarks = test_file.remarks;
    remarks.insert(remarks.end(), reference_file.remarks.begin(), reference_file.remarks.end());
    bring_into_one_frame(reference_file, test_file, request, remarks);
    auto& test = test_file.mesh;
    const auto& reference = reference_file.mesh;
    if (reference.faces.size() == 0)
        throw InputError(fmt::format("{}: the reference has {} but no face; distances need a surface: give a mesh",
                                     request.reference.string(),
                                     base::counted(reference.vertices_mm.size(), "vertex", "vertices")));
    const auto distance =
        naming_any({request.test, request.reference}, [&] { return evaluation::surface_distance(test, reference); });
    if (const auto loose = test.faces.size() > 0 ? vertices_without_face(test) : 0; loose > 0)
        remarks.push_back(fmt::format(
            "{}: {} all the same", request.test.string(),
            base::counted(loose, "vertex belongs to no face and counts", "vertices belong to no face and count")));
    if (!request.output.empty())
        write_distances(request, std::move(test), test_file.frame, distance.test_to_reference, remarks);
    if (!request.common.quiet)
        for (const auto& remark : remarks) say_note(remark);
    if (request.common.json) {
        nlohmann::ordered_json document = {
            {"schema", 1}, {"units", "mm"}, {"test_to_reference", json_of(distance.test_to_reference.summary)}};
        document["reference_to_test"] =
            distance.reference_to_test ? json_of(distance.reference_to_test->summary) : nlohmann::ordered_json(nullptr);
        std::cout << io::json_text(document);
        return;
    }
    std::cout << fmt::format("{:<18} {:>8} {:>10} {:>10} {:>10} {:>10} {:>10} {:>8}\n", "mm", "n", "mean", "rms",
                             "median", "p95", "max", "border")
              << line_of("test to reference", distance.test_to_reference.summary);
    if (distance.reference_to_test)
        std::cout << line_of("reference to test", distance.reference_to_test->summary);
    else if (!request.common.quiet)
        std::cout << "reference to test: none, the test has no face\n";
}

}  // namespace

void add_distance_command(CLI::App& app, int& exit_code) {
    const auto request = std::make_shared<Request>();
    auto* command = app.add_subcommand("distance", "Distances between two surfaces, in both directions");
    command
        ->add_option("TEST", request->test, "Mesh (PLY, OBJ, STL, VTP, PCD), or CSV of points with a header name,x,y,z")
        ->required();
    command->add_option("REFERENCE", request->reference, "Mesh with faces")->required();
    command->add_option("-o,--output", request->output,
                        "VTP or PLY of the test with distance_mm and on_border per vertex");
    add_common_options(*command, request->common);
    command->callback([request, &exit_code] {
        run(*request);
        exit_code = exit_done;
    });
}

}  // namespace mimik::cli
