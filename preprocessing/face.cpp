#include "preprocessing/face.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "geometry/errors.h"
#include "geometry/file.h"
#include "geometry/mesh_io.h"
#include "preprocessing/json_values.h"

namespace mimik::preprocessing {

using geometry::VertexOrigin;
using nlohmann::json;

namespace {

std::filesystem::path with_suffix(const std::filesystem::path& stem, const char* suffix) {
    auto file = stem;
    file += suffix;
    return file;
}

}  // namespace

void write_grid(const std::filesystem::path& file, const geometry::QuadGrid& grid) {
    geometry::Mesh mesh;
    mesh.vertices_mm = grid.vertices_mm;
    mesh.faces = geometry::quads(grid);
    mesh.texture_coordinates = grid.texture_coordinates;
    // Viewers choke on NaN: cells outside the face get the depth of the lowest vertex, and no quad uses them.
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (grid.inside(v)) lowest = std::min(lowest, grid.vertices_mm[v].z());
    geometry::VertexAttribute origin{"origin", 1, {}};
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.inside(v)) {
            mesh.vertices_mm[v].z() = lowest;
            if (!mesh.texture_coordinates.empty()) mesh.texture_coordinates[v].setZero();
        }
        origin.values.push_back(static_cast<double>(grid.origin[v]));
    }
    mesh.attributes.push_back(std::move(origin));
    geometry::write_mesh(file, mesh);
}

geometry::QuadGrid read_grid(const std::filesystem::path& file, int rows, int cols) {
    auto mesh = geometry::read_mesh(file);
    geometry::QuadGrid grid;
    grid.rows = rows;
    grid.cols = cols;
    if (rows < 2 || cols < 2 ||
        mesh.vertices_mm.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols))
        throw InputError(fmt::format("{}: {} vertices where its .json says {} x {}; run 'mimik preprocess' again",
                                     file.string(), mesh.vertices_mm.size(), rows, cols));
    grid.vertices_mm = std::move(mesh.vertices_mm);
    grid.texture_coordinates = std::move(mesh.texture_coordinates);
    for (const auto& attribute : mesh.attributes)
        if (attribute.name == "origin")
            for (const double value : attribute.values) {
                if (!(value == 0 || value == 1 || value == 2))
                    throw InputError(fmt::format("{}: origin {} is none of 0, 1, 2", file.string(), value));
                grid.origin.push_back(static_cast<VertexOrigin>(static_cast<int>(value)));
            }
    if (grid.origin.size() != grid.size())
        throw InputError(fmt::format("{}: property 'origin' is missing; run 'mimik preprocess' again", file.string()));
    for (std::size_t v = 0; v < grid.size(); ++v)
        if (!grid.inside(v)) {  // as gridding leaves them
            grid.vertices_mm[v].z() = std::numeric_limits<double>::quiet_NaN();
            if (!grid.texture_coordinates.empty())
                grid.texture_coordinates[v].setConstant(std::numeric_limits<double>::quiet_NaN());
        }
    return grid;
}

void write_face(const std::filesystem::path& stem, const Face& face) {
    write_grid(with_suffix(stem, ".ply"), face.grid);
    const json document = {
        {"schema", 1},
        {"kind", "mimik face"},
        {"scan", face.id.name()},
        {"subject", face.id.subject},
        {"sex", face.sex},
        {"rows", face.grid.rows},
        {"cols", face.grid.cols},
        {"units", "mm"},
        {"frame", "scanner: +x subject's left, +y up, +z out of the face"},
        {"landmarks", to_json(face.landmarks)},
        {"snapped_landmarks", to_json(face.snapped_landmarks)},
        {"texture_file", face.texture_file.string()},
        {"neutral_from_scan", to_json(face.neutral_from_scan)},
        {"average_from_scan", to_json(face.average_from_scan)},
        {"average_from_scan_affine", to_json(face.average_from_scan_affine)},
        {"alignment_rms_mm", face.alignment_rms_mm},
        {"remarks", face.remarks},
    };
    geometry::write_atomically(with_suffix(stem, ".json"), json_text(document));
}

Face read_face(const std::filesystem::path& stem) {
    const auto file = with_suffix(stem, ".json");
    return from_json_file<Face>(file, [&](const json& document) {
        Face face;
        const auto id = database::parse_scan_name(document.at("scan").get<std::string>());
        if (!id) throw InputError(fmt::format("{}: 'scan' is not a scan name", file.string()));
        face.id = *id;
        face.sex = document.at("sex").get<std::string>();
        face.landmarks = landmarks_from_json(document.at("landmarks"));
        face.snapped_landmarks = landmarks_from_json(document.at("snapped_landmarks"));
        face.texture_file = document.at("texture_file").get<std::string>();
        face.neutral_from_scan = transform_from_json(document.at("neutral_from_scan"));
        face.average_from_scan = transform_from_json(document.at("average_from_scan"));
        face.average_from_scan_affine = transform_from_json(document.at("average_from_scan_affine"));
        face.alignment_rms_mm = document.at("alignment_rms_mm").get<double>();
        face.remarks = document.at("remarks").get<std::vector<std::string>>();
        face.grid =
            read_grid(with_suffix(stem, ".ply"), document.at("rows").get<int>(), document.at("cols").get<int>());
        return face;
    });
}

}  // namespace mimik::preprocessing
