#include <cmath>
#include <sstream>

#include "io/formats/ply.h"
#include "io/mesh_io.h"
#include "preprocessing/average_face.h"
#include "preprocessing/workspace.h"
#include "tests/fuzz/fuzzing.h"

namespace mimik::fuzzing {
namespace {

using namespace preprocessing;

constexpr const char* matrix = "[[1, 0, 0, 5], [0, 0.6, 0.8, 0], [0, -0.8, 0.6, -1e1], [0, 0, 0, 1]]";
constexpr const char* landmarks =
    R"([{"name": "nose_tip", "position_mm": [0, 1.5, 2], "label": "Nose tip"}, {"name": "chin", "position_mm": [1, 2, 3]}])";

void check_marks(const geometry::Landmarks& marks) {
    require(marks.size() <= 10000, "splines stay small");
    for (const auto& mark : marks.all()) require(mark.position_mm.allFinite(), "landmarks are finite");
}

void check_size(const geometry::QuadGrid& grid) {
    require(grid.rows >= 0 && grid.rows <= 20000 && grid.cols >= 0 && grid.cols <= 20000, "a grid has a sane size");
}

void face(std::string_view text) {
    const auto face = decode_face(text, "input");
    check_size(face.grid);
    check_marks(face.landmarks);
    check_marks(face.snapped_landmarks);
    require(face.id.name().find_first_of("/\\") == std::string::npos, "a scan's name leads to no other folder");
    for (const auto* transform : {&face.neutral_from_scan, &face.average_from_scan, &face.average_from_scan_affine})
        require(transform->inverse().matrix().allFinite(), "a transform can be undone");
}

void average(std::string_view text) {
    std::string fingerprint;
    const auto average = decode_average_face(text, "input", &fingerprint);
    check_size(average.grid);
    check_marks(average.landmarks);
}

/// Rows, columns, a PLY.
void grid(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 2) return;
    auto mesh = io::decode_mesh(io::MeshFormat::ply, bytes.subspan(2), "input").mesh;
    const auto grid = to_grid(std::move(mesh), bytes[0], bytes[1], "input");
    require(grid.size() == std::size_t{bytes[0]} * bytes[1] && grid.origin.size() == grid.size(), "cells are whole");
    require(grid.texture_coordinates.empty() || grid.texture_coordinates.size() == grid.size(),
            "one texture position per cell");
    for (std::size_t v = 0; v < grid.size(); ++v)
        require(grid.inside(v) == grid.vertices_mm[v].allFinite(), "inside is where a depth is");
    (void)geometry::triangulate(geometry::quads(grid));
    (void)geometry::to_mesh(grid, geometry::BridgedVertices::leave_out);
}

}  // namespace

/// workspace.json; behind an 'f' the .json of a face, behind an 'a' of the average face, behind a 'g' a grid.
void fuzz_one(std::span<const std::uint8_t> bytes) {
    const auto text = text_of(bytes);
    if (text.starts_with('f')) return face(text.substr(1));
    if (text.starts_with('a')) return average(text.substr(1));
    if (text.starts_with('g')) return grid(bytes.subspan(1));
    const auto list = decode_workspace(text, "input");
    require(std::is_sorted(list.scans.begin(), list.scans.end()), "scans are sorted");
    for (const auto& id : list.scans)
        require(id.name().find_first_of("/\\") == std::string::npos && id.subject.front() != '.',
                "a scan's name leads to no other folder");
}

std::vector<std::string> seeds() {
    geometry::Mesh mesh;
    for (int k = 0; k < 6; ++k) mesh.vertices_mm.emplace_back(k % 3, k / 3, 0.5 * k);
    mesh.faces.add(std::array<std::uint32_t, 4>{0, 1, 4, 3});
    mesh.texture_coordinates.assign(6, {0.25, 0.75});
    mesh.attributes.push_back({"origin", 1, {1, 1, 0, 2, 1, 0}});
    std::vector<std::string> files;
    for (const bool binary : {true, false}) {
        std::ostringstream out;
        io::MeshWriteOptions options;
        options.binary = binary;
        io::formats::encode_ply(out, mesh, options);
        files.push_back("g\x02\x03" + out.str());
    }
    files.push_back(
        R"({"schema": 1, "database": "/db", "truth": true, "scans": ["bs001_N_N_0", "bs000_LFAU_12L_0"], "hidden_subjects": ["bs001"]})");
    files.push_back(
        std::string(R"(f{"schema": 1, "scan": "bs000_N_N_0", "sex": "f", "rows": 150, "cols": 80, "landmarks": )") +
        landmarks + R"(, "snapped_landmarks": [], "texture_file": "/db/bs000/bs000_N_N_0.png", "neutral_from_scan": )" +
        matrix + R"(, "average_from_scan": )" + matrix + R"(, "average_from_scan_affine": )" + matrix +
        R"(, "alignment_rms_mm": 0.25, "remarks": ["a"]})");
    files.push_back(
        std::string(
            R"(a{"schema": 1, "rows": 2, "cols": 20000, "scans": ["bs000_N_N_0"], "consensus_rms_mm": 1.5, "fingerprint": "x", "landmarks": )") +
        landmarks + "}");
    return files;
}

}  // namespace mimik::fuzzing
